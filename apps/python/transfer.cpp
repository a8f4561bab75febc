// Fields from mesh to mesh. The meshes are cut into patches, chares that refer to the job in the
// memory of the interpreter: they read its values there, and write theirs there, each row once.
#include "apps/python/arrays.hpp"
#include "m2m/coupling_weights.hpp"
#include "m2m/mesh_parts.hpp"
#include "m2m/policy.hpp"
#include "runtime/core/hilbert.hpp"
#include "runtime/more/hosted.hpp"

namespace tessera_python {
namespace {

using namespace tess::m2m;
using tess::ErrorCode;
using tess::fail;

/// A field that a job moves, in the memory of arrays.
struct Move {
  std::span<const double> from;
  std::span<double> to;  ///< also what points without a donor keep
  std::size_t n_components = 1;
};

struct Job {
  CouplingOptions options;
  std::vector<MeshPart> source, target;
  std::int64_t n_sources = 0, n_targets = 0;
  std::vector<Move> moves;
  std::vector<std::uint8_t> status;
  std::vector<double> distance;
  SearchSummary summary;
  std::optional<WeightMatrix> weights;
  bool wants_weights = false;
};
/// The job of the run; runs take turns.
Job* job = nullptr;

std::size_t position(tess::m2m::GlobalId id) {
  return static_cast<std::size_t>(id);
}

/// A part of a mesh of the job.
template <class C>
class Patch : public tess::Chare<C, tess::Index1>, public Piece<C> {
 public:
  [[nodiscard]] MeshView mesh_view() const { return tess::m2m::view_of(part()); }

  std::vector<double> field;

 protected:
  [[nodiscard]] const MeshPart& part() const {
    return (C::is_source ? job->source : job->target)[static_cast<std::size_t>(this->index().x)];
  }
  void fetch(std::span<const double> values, std::size_t n_rows, std::size_t n) {
    field.resize(n_rows * n);
    for (std::size_t i = 0; i < n_rows; ++i)
      std::copy_n(&values[position(part().point_ids[i]) * n], n, &field[i * n]);
  }
};

class PythonSource : public Patch<PythonSource> {
 public:
  static constexpr bool is_source = true;
  void begin(std::size_t move) {
    fetch(job->moves[move].from, part().points.size(), job->moves[move].n_components);
  }
};

class PythonTarget : public Patch<PythonTarget> {
 public:
  static constexpr bool is_source = false;
  void begin(std::size_t move) {
    move_ = move;
    fetch(job->moves[move].to, position(part().n_owned), job->moves[move].n_components);
  }
  void received(CouplingId /*coupling*/) {
    const Move& move = job->moves[move_];
    for (std::size_t i = 0; i < position(part().n_owned); ++i)
      std::copy_n(&field[i * move.n_components], move.n_components,
                  &move.to[position(part().point_ids[i]) * move.n_components]);
  }
  void report(CouplingId coupling) {
    const auto of_status = status(coupling);
    const auto of_distance = distance(coupling);
    for (std::size_t i = 0; i < of_status.size(); ++i) {
      const std::size_t to = position(part().point_ids[i]);
      job->status[to] = static_cast<std::uint8_t>(of_status[i]);
      if (!of_distance.empty()) job->distance[to] = of_distance[i];
    }
  }

 private:
  std::size_t move_ = 0;
};

tess::Task work(Job& of) {
  job = &of;
  const auto n = [](const std::vector<MeshPart>& parts) {
    return tess::range(static_cast<std::int32_t>(parts.size()));
  };
  tess::ArrayProxy<PythonSource> source;
  tess::ArrayProxy<PythonTarget> target;
  co_await tess::epoch([&] {
    source = tess::create<PythonSource>(n(of.source));
    target = tess::create<PythonTarget>(n(of.target));
  });
  Coupling coupling(source, target, of.options);
  of.summary = co_await coupling.search();
  const CouplingId id = coupling.id();
  co_await tess::epoch([&] { target.broadcast<&PythonTarget::report>(id); });
  if (of.wants_weights) of.weights = co_await collect_weights(coupling, of.n_sources, of.n_targets);
  for (std::size_t k = 0; k < of.moves.size(); ++k) {
    co_await tess::epoch([&] {
      source.broadcast<&PythonSource::begin>(k);
      target.broadcast<&PythonTarget::begin>(k);
    });
    co_await coupling.apply<&PythonSource::field, &PythonTarget::field>();
  }
}

/// Consecutive points of a Hilbert curve, as parts of equal numbers.
std::vector<MeshPart> cloud_parts(std::span<const Point> points, std::size_t n_parts) {
  const Aabb box = tess::collide::box_around(points);
  constexpr unsigned levels = 16;
  const auto key_of = [&](const Point& p) {
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = box.hi[k] - box.lo[k];
      if (side > 0) cell[k] = static_cast<std::uint32_t>((p[k] - box.lo[k]) / side * 65535.0);
    }
    return tess::hilbert_key(cell, 3, levels);
  };
  std::vector<std::pair<std::uint64_t, GlobalId>> order;
  order.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    order.emplace_back(key_of(points[i]), static_cast<GlobalId>(i));
  std::sort(order.begin(), order.end());
  std::vector<MeshPart> parts(n_parts);
  for (std::size_t k = 0; k < n_parts; ++k) {
    for (std::size_t i = points.size() * k / n_parts; i < points.size() * (k + 1) / n_parts; ++i)
      parts[k].point_ids.push_back(order[i].second);
    std::sort(parts[k].point_ids.begin(), parts[k].point_ids.end());
    for (const GlobalId id : parts[k].point_ids) parts[k].points.push_back(points[position(id)]);
    parts[k].n_owned = static_cast<std::int64_t>(parts[k].points.size());
  }
  return parts;
}

/// Kind, outside, tolerance, order, clamp.
using Options = std::tuple<std::string, std::string, double, std::int32_t, bool>;

CouplingOptions options_of(const Options& given, const TetMesh& source, const TetMesh& target) {
  CouplingOptions options;
  options.kind = parse_transfer_kind(std::get<0>(given));
  options.policy = parse_policy(std::get<1>(given));
  std::tie(std::ignore, std::ignore, options.tolerance, options.order, options.clamp) = given;
  check(options);
  if (source.tets.empty() && options.kind != TransferKind::nearest &&
      options.kind != TransferKind::moving_least_squares)
    fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
         " needs source_tets; without them, choose nearest or moving-least-squares");
  if (is_conservative(options.kind) && target.tets.empty())
    fail(ErrorCode::bad_argument, "kind ", name_of(options.kind),
         " integrates over cells of the target: give target_tets");
  require_dimensions(options.kind, options.tolerance, source.dimension, target.dimension);
  return options;
}

std::vector<MeshPart> parts_of(const TetMesh& mesh, std::int32_t halo_layers, bool as_cloud,
                               std::size_t n_parts) {
  if (!mesh.tets.empty()) (void)validate(mesh);
  if (as_cloud)
    return cloud_parts(mesh.points, std::max<std::size_t>(std::min(n_parts, mesh.n_points()), 1));
  return mesh_parts(mesh, static_cast<std::int32_t>(std::min(n_parts, mesh.n_tets())),
                    PartitionMethod::curve, halo_layers);
}

/// `fields`: (n, …) each; `results`: (k, …) each, with what points without a donor keep.
py::tuple transfer(const MeshArrays& from, const MeshArrays& to,
                   const std::vector<Array<double>>& fields, std::vector<Array<double>> results,
                   const Options& options, bool wants_weights, std::int32_t pes) {
  const TetMesh source = mesh_of(from, "source"), target = mesh_of(to, "target");
  Job of;
  of.options = options_of(options, source, target);
  if (wants_weights) require_weights(of.options.kind, of.options.clamp);
  of.wants_weights = wants_weights;
  of.n_sources = static_cast<std::int64_t>(source.n_points());
  of.n_targets = static_cast<std::int64_t>(target.n_points());
  for (std::size_t k = 0; k < fields.size(); ++k)
    of.moves.push_back({rows<double>(fields[k]),
                        {results[k].mutable_data(), static_cast<std::size_t>(results[k].size())},
                        static_cast<std::size_t>(fields[k].size()) / source.n_points()});
  const bool conserves = is_conservative(of.options.kind);
  {
    const py::gil_scoped_release others_run;
    const std::size_t n_parts = 8 * static_cast<std::size_t>(std::clamp(pes, 1, 4096));
    of.source = parts_of(source, source_halo_layers(of.options.kind), source.tets.empty(), n_parts);
    of.target = parts_of(target, target_halo_layers(of.options.kind), !conserves, n_parts);
    of.status.assign(target.n_points(), static_cast<std::uint8_t>(Status::outside));
    of.distance.assign(target.n_points(), 0.0);
    tess::run_hosted(pes, [&] { return work(of); });
  }
  const Tally& tally = of.summary.tally;
  py::dict notes;
  if (tally.n_overcovered != 0) notes["overcovered"] = tally.n_overcovered;
  if (tally.n_lower_order != 0) notes["lower_order"] = tally.n_lower_order;
  if (tally.n_lower_dimension != 0) notes["lower_dimension"] = tally.n_lower_dimension;
  py::object distance = py::none();
  if (!conserves) distance = array_of(std::move(of.distance));
  return py::make_tuple(array_of(std::move(of.status)), distance, std::move(of.weights), notes);
}

void apply_weights(const WeightMatrix& matrix, const Array<double>& field, Array<double> result) {
  const auto n = static_cast<std::size_t>(field.size() / matrix.n_columns);
  const std::span<double> to{result.mutable_data(), static_cast<std::size_t>(result.size())};
  const py::gil_scoped_release others_run;
  apply(matrix, rows<double>(field), n, to);
}

/// SciPy's (data, indices, indptr, shape); the arrays are views of the matrix.
py::tuple csr(const py::object& self) {
  const auto& matrix = self.cast<const WeightMatrix&>();
  const Rows<double>& rows = matrix.rows;
  const auto view = [&]<class T>(const std::vector<T>& list) {
    py::array_t<T> array(static_cast<py::ssize_t>(list.size()), list.data(), self);
    array.attr("flags").attr("writeable") = false;
    return array;
  };
  return py::make_tuple(view(rows.weights), view(rows.columns),
                        view(rows.begin).attr("astype")("int64"),
                        py::make_tuple(matrix.n_rows(), matrix.n_columns));
}

}  // namespace

void add_transfer(py::module_& module) {
  py::class_<WeightMatrix>(module, "Weights").def("csr", &csr).def("apply", &apply_weights);
  module.def("transfer", &transfer);
}

}  // namespace tessera_python
