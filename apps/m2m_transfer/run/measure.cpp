#include "apps/m2m_transfer/run/measure.hpp"

#include "apps/m2m_transfer/run/steps.hpp"
#include "m2m/write_pvtu.hpp"

#include <algorithm>
#include <optional>
#include <sys/resource.h>

namespace m2m_transfer {
namespace {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// The fastest search and application of several.
void keep_fastest(PhaseSeconds& best, const PhaseSeconds& other, bool first) {
  if (!first && other.transfer() >= best.transfer()) return;
  best.broad = other.broad;
  best.narrow = other.narrow;
  best.again = other.again;
  best.apply = other.apply;
}

void report_audit(Problem& problem, std::size_t p, const PairAudit& audit) {
  TransferReport& report = problem.reports[p];
  const Pair& pair = problem.pairs[p];
  for (std::size_t f = 0; f < problem.field_names.size(); ++f) {
    const std::string& name = problem.field_names[f];
    FieldError error{name, audit.target[f].all, audit.target[f].found};
    error.source_integral = audit.source[f].integral;
    error.target_integral = audit.target[f].integral;
    if (problem.kind == TransferKind::linear && needs_values(pair.source, problem.pairs))
      if (const auto second = largest_second_derivative(name, problem.domain))
        error.bound = linear_bound(problem.source_of(pair).survey.longest_edge, *second);
    report.fields.push_back(std::move(error));
  }
  report.result_hash = audit.result_hash;
  report.worst_at = audit.target.front().worst_at;
}

/// Brings the fields of the meshes that were written to this PE.
Task collect(Problem& problem, const std::vector<DistributedMesh>& meshes, const GraphRun& graph) {
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (!is_written(m, problem.pairs)) continue;
    RunMesh& mesh = problem.meshes[m];
    const Time begin = now();
    Gathered result = co_await gather(meshes[m], static_cast<std::size_t>(mesh.survey.n_points));
    const double took = seconds_since(begin);
    for (std::size_t p = 0; p < problem.pairs.size(); ++p)
      if (problem.pairs[p].target == m) problem.reports[p].seconds.gather = took;
    mesh.fields.clear();
    for (std::size_t f = 0; f < problem.field_names.size(); ++f)
      mesh.fields.push_back({problem.field_names[f], 1, std::move(result.values[f])});
    mesh.fields.push_back(status_field(result.status, mesh.fields));
    mesh.made = graph.made(m);
    mesh.back = graph.back(m);
  }
}

}  // namespace

Footprint JoinFootprints::operator()(Footprint a, const Footprint& b) const {
  a.peak_memory_bytes += b.peak_memory_bytes;
  a.greatest_peak_memory_bytes =
      std::max(a.greatest_peak_memory_bytes, b.greatest_peak_memory_bytes);
  a.bytes_sent += b.bytes_sent;
  return a;
}

void Gauge::read(Callback<Footprint> target) {
  const Machine& machine = tess::machine();
  Footprint mine;
  mine.bytes_sent = statistics().bytes_sent;
  // All simulated processes share the memory of process 0.
  if (machine.process_of(pe()) == machine.process() && machine.is_first_of_process(pe()))
    mine.peak_memory_bytes = mine.greatest_peak_memory_bytes = peak_memory_bytes();
  contribute(JoinFootprints{}, mine, std::move(target));
}

Task measure(Problem& problem, GroupProxy<Gauge> gauge, kit::Progress& progress) {
  const Footprint sent_before = co_await gauge.reduce<&Gauge::read>();

  progress.phase("partition");
  const Time start = now();
  std::vector<DistributedMesh> meshes = co_await place(problem);
  const double setup = seconds_since(start);
  std::optional<GraphRun> graph;
  for (std::int32_t round = 0; round < problem.repeat; ++round) {
    graph.emplace(problem, meshes, progress);
    co_await graph->search();
    if (round + 1 < problem.repeat)
      co_await graph->steps();
    else
      co_await graph->steps_with_audits();
    for (std::size_t p = 0; p < problem.reports.size(); ++p)
      keep_fastest(problem.reports[p].seconds, graph->seconds()[p], round == 0);
    if (round == 0) {
      const Footprint sent_after = co_await gauge.reduce<&Gauge::read>();
      for (TransferReport& report : problem.reports)
        report.footprint.bytes_sent = sent_after.bytes_sent - sent_before.bytes_sent;
    }
    if (round + 1 < problem.repeat) co_await graph->destroy();
  }
  for (std::size_t p = 0; p < problem.pairs.size(); ++p)
    report_audit(problem, p, graph->audits()[p]);
  if (!problem.parts_path.empty()) {
    progress.phase("writing");
    for (std::size_t m = 0; m < meshes.size(); ++m)
      if (is_written(m, problem.pairs))
        co_await write_pvtu(path_of_result(problem.parts_path, m, meshes.size(), problem.pairs),
                            meshes[m], problem.field_names);
  }
  if (problem.collects) {
    progress.phase("gather");
    co_await collect(problem, meshes, *graph);
  }
  co_await graph->destroy();
  const Footprint peak = co_await gauge.reduce<&Gauge::read>();
  for (std::size_t p = 0; p < problem.reports.size(); ++p) {
    TransferReport& report = problem.reports[p];
    report.seconds.setup = setup;
    report.tally = graph->found()[p].tally;
    report.worst = graph->found()[p].worst;
    report.searches = graph->searches(p);
    report.footprint.peak_memory_bytes = peak.peak_memory_bytes;
    report.footprint.greatest_peak_memory_bytes = peak.greatest_peak_memory_bytes;
  }
  co_await destroy(meshes);
}

}  // namespace m2m_transfer
