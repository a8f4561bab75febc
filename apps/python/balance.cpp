// Snapshots of loads, strategies by name and strategies that are functions of Python.
#include "apps/python/arrays.hpp"
#include "runtime/more/balance_offline.hpp"

#include <cmath>
#include <limits>

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
  out["edges"] = matrix_of<std::int64_t>(std::move(edges), 4);
  out["positions"] = matrix_of<double>(s.elements.position);
  return out;
}

Assignment assignment_of(const Array<std::int32_t>& pes) {
  Assignment out;
  for (const std::int32_t pe : rows<std::int32_t>(pes)) out.push_back(tess::PeId{pe});
  return out;
}

Snapshot make_snapshot(const Array<double>& loads, const Array<std::int32_t>& owners,
                       const std::vector<double>& speeds, const std::vector<double>& background,
                       const std::vector<std::uint64_t>& sizes, const Array<std::int64_t>& edges,
                       const Array<double>& positions) {
  Snapshot s;
  for (const double load : rows<double>(loads)) {
    s.elements.key.push_back({{}, s.elements.load.size()});
    s.elements.load.push_back(std::isnan(load) ? Load::unknown() : Load(load));
  }
  s.elements.pe = assignment_of(owners);
  s.elements.migratable.assign(s.elements.size(), 1);
  s.elements.size_bytes = s.elements.memory_bytes = sizes;
  const auto places = rows<std::array<double, 3>>(positions);
  s.elements.position.assign(places.begin(), places.end());
  s.pes = {background, speeds, std::vector<std::uint64_t>(speeds.size(), 0), {}};
  for (const auto& [from, to, bytes, messages] : rows<std::array<std::uint64_t, 4>>(edges))
    s.edges.push_back({from, to, bytes, messages});
  validate(s);
  return s;
}

/// `strategy`: a name, or a function without arguments, of Python.
py::array_t<std::int32_t> assign(const Snapshot& s, const py::object& strategy,
                                 std::uint64_t seed) {
  if (!py::isinstance<py::str>(strategy)) {
    return pes_of(make_strategy(
        [&](const Snapshot&) { return assignment_of(strategy().cast<Array<std::int32_t>>()); })(s));
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

py::tuple evaluate(const Snapshot& s, const Array<std::int32_t>& owners) {
  const Metrics metrics = measure(s, assignment_of(owners));
  return py::make_tuple(metrics.max_over_average, metrics.n_moves, metrics.moved_bytes,
                        metrics.external_bytes);
}

std::vector<Snapshot> read(const std::vector<std::string>& paths) {
  std::vector<Snapshot> out;
  for (Phase& phase : read_lb_datafiles(paths)) out.push_back(std::move(phase.snapshot));
  return out;
}

}  // namespace

void add_balance(py::module_& module) {
  py::class_<Snapshot>(module, "Snapshot").def(py::init(&make_snapshot));
  module.def("arrays", &arrays_of);
  module.def("assign", &assign);
  module.def("evaluate", &evaluate);
  module.def("strategies", &strategy_names);
  module.def("read_snapshots", &read);
}

}  // namespace tessera_python
