#include "apps/m2m_transfer/run/reference.hpp"

#include "apps/m2m_transfer/run/meshes.hpp"
#include "m2m/field_norms.hpp"
#include "m2m/radial_basis.hpp"
#include "m2m/read_mesh.hpp"

#include <utility>

namespace m2m_transfer {
namespace {

TetMesh whole(const RunMesh& mesh) {
  return mesh.mesh ? *mesh.mesh : read_mesh(mesh.name);
}

}  // namespace

TaskOf<TransferReport> measure_reference(const Problem& problem) {
  const TetMesh source = whole(problem.source_of(problem.pairs.front()));
  const TetMesh target = whole(problem.target_of(problem.pairs.front()));
  const std::size_t n_fields = problem.field_names.size();
  std::vector<double> given(source.n_points() * n_fields);
  std::vector<FormulaField> truth;
  for (std::size_t f = 0; f < n_fields; ++f) {
    const Field field = sample(source, problem.field_names[f], problem.formulas[f]);
    for (std::size_t i = 0; i < source.n_points(); ++i) given[i * n_fields + f] = field.values[i];
    truth.push_back({problem.field_names[f], problem.domain});
  }
  const Time start = now();
  const RadialBasis basis(source.points);
  const Time factored = now();
  const std::vector<double> values = basis.values(given, n_fields, target.points);
  TransferReport report = problem.reports.front();
  report.kind = "radial-basis";
  report.seconds = {.narrow = seconds(factored - start), .apply = seconds_since(factored)};
  report.pes = report.processes = report.chares = 1;
  report.tally = {};
  report.worst = {};
  report.footprint = {};
  report.searches = 1;
  report.result_hash = result_hash(values);

  DistributedMesh result;
  co_await epoch([&] {
    result = scatter(target, {{"all", n_fields, values}}, 1, PartitionMethod::curve);
  });
  const std::vector<FieldNorms> norms =
      co_await measure_norms(result, target.name, std::move(truth));
  co_await epoch([&] { result.destroy(); });
  for (std::size_t f = 0; f < n_fields; ++f) {
    FieldError& field = report.fields[f];
    field.norms = norms[f].all;
    field.found = norms[f].found;
    field.target_integral = norms[f].integral;
    field.bound.reset();
  }
  report.worst_at = norms.front().worst_at;
  co_return report;
}

}  // namespace m2m_transfer
