// Snapshots of loads, strategies by name and strategies that are functions of Python.
#include "apps/python/arrays.hpp"
#include "apps/python/module.hpp"
#include "runtime/more/balance_offline.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <pybind11/stl.h>

namespace tessera_python {
namespace {

using namespace tess::balance;
using tess::ErrorCode;
using tess::fail;

py::array_t<std::int32_t> pes_of(const Assignment& assignment) {
  std::vector<std::int32_t> pes;
  for (const tess::PeId pe : assignment) pes.push_back(pe.value);
  return array_of(std::move(pes));
}

/// What tessera/balance.py keeps of a snapshot.
py::dict arrays_of(const Snapshot& s) {
  const auto n = static_cast<py::ssize_t>(s.elements.size());
  std::vector<double> loads;
  for (const Load load : s.elements.load)
    loads.push_back(load.seconds_or(std::numeric_limits<double>::quiet_NaN()));
  std::vector<std::int64_t> edges;
  for (const Edge& edge : s.edges)
    for (const std::uint64_t number :
         {std::uint64_t{edge.from}, std::uint64_t{edge.to}, edge.bytes, edge.messages})
      edges.push_back(static_cast<std::int64_t>(number));
  py::dict out;
  out["loads"] = array_of(std::move(loads));
  out["owners"] = pes_of(s.elements.pe);
  out["movable"] = array_of<bool>(s.elements.migratable, {n});
  out["sizes"] = array_of(s.elements.size_bytes);
  out["speeds"] = array_of(s.pes.speed);
  out["background"] = array_of(s.pes.background);
  out["edges"] =
      array_of<std::int64_t>(std::move(edges), {static_cast<py::ssize_t>(s.edges.size()), 4});
  out["positions"] = array_of<double>(s.elements.position,
                                      {static_cast<py::ssize_t>(s.elements.position.size()), 3});
  return out;
}

/// Numbers per element or PE: those given, or `otherwise` for each.
std::vector<double> column(const py::handle& given, const char* name, std::size_t n,
                           double otherwise, const char* things) {
  if (given.is_none()) return std::vector<double>(n, otherwise);
  const Doubles array = doubles(given, name, {static_cast<py::ssize_t>(n)},
                                tess::text("(", n, ",), one per ", things));
  require_finite(array, name);
  return {array.data(), array.data() + n};
}

std::uint64_t whole(double number, const char* name, std::size_t i) {
  if (!(number >= 0 && number < 0x1p53 && number == std::floor(number)))
    fail(ErrorCode::bad_value, name, "[", i, "] is ", number,
         "; give a whole number of bytes or messages, from 0 on");
  return static_cast<std::uint64_t>(number);
}

Assignment assignment_of(const py::handle& given, const char* name, std::size_t n_elements,
                         std::size_t n_pes) {
  const Integers pes = indices(given, name, {static_cast<py::ssize_t>(n_elements)},
                               tess::text("(", n_elements, ",), a PE per element"), n_pes, "PEs");
  Assignment out;
  out.reserve(n_elements);
  for (std::size_t i = 0; i < n_elements; ++i)
    out.push_back(pe_at(static_cast<std::size_t>(pes.data()[i])));
  return out;
}

Snapshot make_snapshot(const py::handle& loads, const py::handle& owners, std::int64_t n_pes,
                       const py::handle& speeds, const py::handle& background,
                       const py::handle& sizes, const py::handle& edges,
                       const py::handle& positions) {
  if (n_pes < 1 || n_pes > 1 << 24)
    fail(ErrorCode::bad_argument, "n_pes: ", n_pes, " is not a number of PEs from 1 to ", 1 << 24);
  Snapshot s;
  const Doubles seconds = doubles(loads, "loads", {-1}, "(n,), seconds of each element");
  const auto n = static_cast<std::size_t>(seconds.size());
  const auto pes = static_cast<std::size_t>(n_pes);
  for (std::size_t i = 0; i < n; ++i) {
    const double load = seconds.data()[i];
    if (!std::isnan(load) && !(load >= 0 && load < HUGE_VAL))
      fail(ErrorCode::bad_value, "loads[", i, "] is ", load,
           "; give seconds from 0 on, or NaN where the load is unknown");
    s.elements.load.push_back(std::isnan(load) ? Load::unknown() : Load(load));
    s.elements.key.push_back({{}, i});
  }
  s.elements.pe = assignment_of(owners, "owners", n, pes);
  s.elements.migratable.assign(n, 1);
  const std::vector<double> bytes = column(sizes, "sizes", n, 0, "element");
  for (std::size_t i = 0; i < n; ++i) s.elements.size_bytes.push_back(whole(bytes[i], "sizes", i));
  s.elements.memory_bytes = s.elements.size_bytes;
  s.pes.speed = column(speeds, "speeds", pes, 1, "PE");
  s.pes.background = column(background, "background", pes, 0, "PE");
  s.pes.memory_limit_bytes.assign(pes, 0);
  if (!positions.is_none()) {
    const Doubles at = doubles(positions, "positions", {static_cast<py::ssize_t>(n), 3},
                               "(n, 3), x, y, z of each element");
    require_finite(at, "positions");
    const auto all = rows<std::array<double, 3>>(at);
    s.elements.position.assign(all.begin(), all.end());
  }
  if (!edges.is_none()) {
    const Integers all = indices(edges, "edges", {-1, 4}, "(m, 4): from, to, bytes, messages",
                                 std::size_t{1} << 53U, "bytes at most");
    for (py::ssize_t i = 0; i < all.shape(0); ++i) {
      const std::int64_t* const edge = all.data(i, 0);
      for (int end = 0; end < 2; ++end)
        if (static_cast<std::size_t>(edge[end]) >= n)
          fail(ErrorCode::out_of_range, "edges[", i, ", ", end, "] is ", edge[end],
               ", and there are ", n, " elements, numbered from 0 on");
      s.edges.push_back({static_cast<std::size_t>(edge[0]), static_cast<std::size_t>(edge[1]),
                         static_cast<std::uint64_t>(edge[2]), static_cast<std::uint64_t>(edge[3])});
    }
  }
  validate(s);
  return s;
}

/// `strategy`: a name, or a function without arguments, of Python.
py::array_t<std::int32_t> assign(const Snapshot& s, const py::object& strategy,
                                 std::uint64_t seed) {
  if (!py::isinstance<py::str>(strategy)) {
    if (PyCallable_Check(strategy.ptr()) == 0)
      fail(ErrorCode::bad_argument, "strategy: ", std::string(py::str(py::type::of(strategy))),
           " is no name and no function; see strategies()");
    return pes_of(make_strategy([&](const Snapshot&) {
      return assignment_of(strategy(), "PEs of the strategy", s.elements.size(), s.pes.size());
    })(s));
  }
  const auto name = strategy.cast<std::string>();
  const Strategy run = make_strategy(name, seed);
  if (const std::string why = obstacle(name, s); !why.empty())
    fail(ErrorCode::bad_argument, "strategy ", name, ": ", why, "; choose another one");
  Assignment chosen;
  {
    const py::gil_scoped_release others_run;
    chosen = run(s);
  }
  return pes_of(chosen);
}

py::dict evaluate(const Snapshot& s, const py::handle& owners) {
  const Metrics metrics =
      measure(s, assignment_of(owners, "owners", s.elements.size(), s.pes.size()));
  py::dict out;
  out["imbalance"] = metrics.max_over_average;
  out["moves"] = metrics.n_moves;
  out["moved_bytes"] = metrics.moved_bytes;
  out["external_bytes"] = metrics.external_bytes;
  return out;
}

std::vector<Snapshot> read(const std::vector<std::string>& paths) {
  std::vector<Snapshot> out;
  for (Phase& phase : read_lb_datafiles(paths)) out.push_back(std::move(phase.snapshot));
  return out;
}

void write(const std::string& path, const std::vector<Snapshot>& snapshots) {
  std::vector<Phase> phases;
  for (const Snapshot& s : snapshots) phases.push_back({phases.size(), s});
  std::ofstream file(path, std::ios::binary);
  file << lb_datafile_bytes(path, write_lb_datafile(phases));
  file.close();
  if (!file)
    fail(ErrorCode::environment, path, " cannot be written; check the folder and the disk");
}

}  // namespace

void add_balance(py::module_& module) {
  py::class_<Snapshot>(module, "Snapshot").def(py::init(&make_snapshot));
  module.def("arrays", &arrays_of);
  module.def("assign", &assign);
  module.def("evaluate", &evaluate);
  module.def("strategies", &strategy_names);
  module.def("read_snapshots", &read);
  module.def("write_snapshots", &write);
}

}  // namespace tessera_python
