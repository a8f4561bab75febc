#include "apps/m2m_transfer/run/measure.hpp"

#include "apps/m2m_transfer/input/formulas.hpp"
#include "apps/m2m_transfer/input/status_field.hpp"
#include "apps/m2m_transfer/run/steps.hpp"

#include <optional>

namespace m2m_transfer {
namespace {

/// The fastest search and application of several.
void keep_fastest(PhaseSeconds& best, const PhaseSeconds& other, bool first) {
  if (!first && other.transfer() >= best.transfer()) return;
  best.broad = other.broad;
  best.narrow = other.narrow;
  best.again = other.again;
  best.apply = other.apply;
}

/// Compares the result of a pair with the formulas at the places where the target is now. The
/// formulas follow the mesh that the values were sampled on.
void compare_with_truth(Problem& problem, const GraphRun& graph, std::size_t p,
                        const Gathered& result, const std::vector<double>& source_integrals) {
  TransferReport& report = problem.reports[p];
  const Pair& pair = problem.pairs[p];
  RunMesh& target = problem.target_of(pair);
  std::vector<bool> found(result.status.size());
  for (std::size_t v = 0; v < found.size(); ++v) found[v] = result.status[v] != Status::outside;
  TetMesh there;
  there.points = target.mesh.points;
  undo(there.points, graph.motions(graph.origin(pair.target)));
  const std::vector<double> masses = row_sums(target.mesh);
  const Aabb domain = bounds(problem.source_of(problem.pairs.front()).mesh);
  std::uint64_t hash = result_hash({});
  target.fields.clear();
  for (std::size_t f = 0; f < problem.formulas.size(); ++f) {
    const std::string& name = problem.field_names[f];
    const std::vector<double>& values = result.values[f];
    const Field truth = sample(there, name, problem.formulas[f]);
    FieldError error{name, error_norms(target.mesh, values, truth.values),
                     error_norms(target.mesh, values, truth.values, found)};
    error.source_integral = source_integrals[f];
    error.target_integral = integral(masses, values);
    if (problem.kind == TransferKind::linear && needs_values(pair.source, problem.pairs))
      if (const auto second = largest_second_derivative(name, domain))
        error.bound = linear_bound(longest_edge(problem.source_of(pair).mesh), *second);
    report.fields.push_back(std::move(error));
    hash = result_hash(values, hash);
    target.fields.push_back({name, 1, values});
  }
  target.fields.push_back(status_field(result.status));
  report.result_hash = hash;
  report.worst_at = target.mesh.points[static_cast<std::size_t>(report.fields.front().norms.worst)];
}

}  // namespace

Task measure(Problem& problem, GroupProxy<Gauge> gauge, apps::Progress& progress) {
  Future<Footprint> before, after, most;
  gauge.broadcast<&Gauge::read>(before.callback());
  const Footprint sent_before = co_await before;

  progress.phase("partition");
  const Time start = now();
  std::vector<DistributedMesh> meshes;
  co_await place(problem, problem.kind, problem.chares(), meshes);
  const double setup = seconds_since(start);
  std::optional<GraphRun> graph;
  for (std::int32_t round = 0; round < problem.repeat; ++round) {
    graph.emplace(problem, meshes, progress);
    co_await graph->search();
    co_await graph->steps();
    for (std::size_t p = 0; p < problem.reports.size(); ++p)
      keep_fastest(problem.reports[p].seconds, graph->seconds()[p], round == 0);
    if (round == 0) {
      gauge.broadcast<&Gauge::read>(after.callback());
      const Footprint sent_after = co_await after;
      for (TransferReport& report : problem.reports)
        report.footprint.bytes_sent = sent_after.bytes_sent - sent_before.bytes_sent;
    }
    if (round + 1 < problem.repeat) co_await graph->destroy();
  }
  progress.phase("comparison with the truth");
  std::vector<std::vector<double>> integrals(problem.pairs.size());
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    const std::size_t source = problem.pairs[p].source;
    const RunMesh& mesh = problem.meshes[source];
    Gathered values;
    if (is_written(source, problem.pairs))
      co_await gather(meshes[source], mesh.mesh.n_points(), values);
    const std::vector<double> masses = row_sums(mesh.mesh);
    for (std::size_t f = 0; f < mesh.fields.size(); ++f)
      integrals[p].push_back(
          integral(masses, values.values.empty() ? mesh.fields[f].values : values.values[f]));
  }
  co_await graph->finish([&](std::size_t p, const Gathered& result) {
    compare_with_truth(problem, *graph, p, result, integrals[p]);
  });
  co_await graph->destroy();
  gauge.broadcast<&Gauge::read>(most.callback());
  const Footprint peak = co_await most;
  for (std::size_t p = 0; p < problem.reports.size(); ++p) {
    TransferReport& report = problem.reports[p];
    report.seconds.setup = setup;
    report.seconds.gather = graph->seconds()[p].gather;
    report.counts = graph->found()[p].tally.counts;
    report.worst = graph->found()[p].worst;
    report.n_candidates = graph->found()[p].tally.n_candidates;
    report.n_kept_sources = graph->found()[p].tally.n_kept_sources;
    report.searches = graph->searches();
    report.footprint.peak_memory_bytes = peak.peak_memory_bytes;
    report.footprint.greatest_peak_memory_bytes = peak.greatest_peak_memory_bytes;
  }
  co_await destroy(meshes);
}

}  // namespace m2m_transfer
