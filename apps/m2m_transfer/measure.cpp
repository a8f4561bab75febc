#include "apps/m2m_transfer/measure.hpp"

#include "m2m/placement.hpp"
#include "m2m/transfer.hpp"

#include <algorithm>

namespace m2m_transfer {
namespace {

double seconds_since(Time start) {
  return seconds(now() - start);
}

/// Stores the gathered values of all vertices in global order.
void store(const Outcome& outcome, Problem& problem) {
  const std::size_t n_fields = problem.target_fields.size();
  std::vector<double> status(problem.target.n_points());
  for (std::size_t i = 0; i < outcome.points.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(outcome.points[i]);
    status[vertex] = static_cast<double>(outcome.status[i]);
    for (std::size_t f = 0; f < n_fields; ++f)
      problem.target_fields[f].values[vertex] = outcome.values[i * n_fields + f];
  }
  problem.target_fields.push_back({"status", 1, std::move(status)});
}

void compare_with_truth(Problem& problem) {
  TransferReport& report = problem.report;
  std::uint64_t hash = result_hash({});
  const Field& status = problem.target_fields.back();
  std::vector<bool> found(status.values.size());
  for (std::size_t v = 0; v < found.size(); ++v)
    found[v] = status.values[v] != static_cast<double>(Status::outside);
  for (std::size_t f = 0; f < problem.truth.size(); ++f) {
    const Field& truth = problem.truth[f];
    const std::vector<double>& values = problem.target_fields[f].values;
    report.fields.push_back({truth.name, error_norms(problem.target, values, truth.values),
                             error_norms(problem.target, values, truth.values, found)});
    hash = result_hash(values, hash);
  }
  report.result_hash = hash;
  report.worst_at =
      problem.target.points[static_cast<std::size_t>(report.fields.front().norms.worst)];
}

}  // namespace

Task measure(Problem& problem, GroupProxy<Gauge> gauge, apps::Progress& progress) {
  TransferReport& report = problem.report;
  Future<Footprint> before, after, most;
  gauge.broadcast<&Gauge::read>(before.callback());
  const Footprint sent_before = co_await before;

  progress.phase("partition");
  const Time start = now();
  DistributedMesh source, target;
  if (problem.partition == PartitionMethod::curve) {
    // All PEs read and cut together, and sample the fields where the points are.
    PlaceOptions there{report.chares, source_halo_layers(problem.kind), {}};
    PlaceOptions here{report.chares, target_halo_layers(problem.kind), {}};
    for (const Field& field : problem.source_fields)
      there.fields.push_back({field.name, problem.source_census.bounds});
    here.fields.assign(problem.target_fields.size(), {"0", {}});
    PlacedMesh placed_source, placed_target;
    Task first = place(report.source, there, &placed_source);
    Task second = place(report.target, here, &placed_target);
    co_await first;
    co_await second;
    source = placed_source.mesh;
    target = placed_target.mesh;
  } else {
    co_await epoch([&] {
      source = scatter(problem.source, problem.source_fields, report.chares, problem.partition,
                       source_halo_layers(problem.kind));
      target = scatter(problem.target, problem.target_fields, report.chares, problem.partition,
                       target_halo_layers(problem.kind));
    });
  }
  report.seconds.setup = seconds_since(start);
  TransferOptions options;
  options.voxel_size = problem.voxel;
  options.policy = problem.policy;
  options.kind = problem.kind;
  options.on_phase = [&progress](const char* name) { progress.phase(name); };
  for (std::int32_t round = 0; round < problem.repeat; ++round) {
    Transfer transfer(source, target, options);
    SearchSummary search;
    co_await transfer.search(&search);
    progress.phase("apply");
    double apply = 0;
    for (std::int32_t step = 0; step < problem.steps; ++step) {
      const Time begin = now();
      co_await transfer.apply();
      apply = step == 0 ? seconds_since(begin) : std::min(apply, seconds_since(begin));
    }
    PhaseSeconds& best = report.seconds;
    if (round == 0 || search.broad + search.narrow + apply < best.transfer()) {
      best.broad = search.broad;
      best.narrow = search.narrow;
      best.apply = apply;
    }
    co_await epoch([&] { transfer.destroy(); });
    if (round != 0) continue;
    report.counts = search.tally.counts;
    report.n_candidates = search.tally.n_candidates;
    gauge.broadcast<&Gauge::read>(after.callback());
    report.footprint.bytes_sent = (co_await after).bytes_sent - sent_before.bytes_sent;
  }
  progress.phase("comparison with the truth");
  Future<Outcome> outcome;
  target.workers.broadcast<&Worker::gather>(outcome.callback());
  store(co_await outcome, problem);
  compare_with_truth(problem);
  gauge.broadcast<&Gauge::read>(most.callback());
  const Footprint peak = co_await most;
  report.footprint.peak_memory_bytes = peak.peak_memory_bytes;
  report.footprint.greatest_peak_memory_bytes = peak.greatest_peak_memory_bytes;
  co_await epoch([&] {
    source.destroy();
    target.destroy();
  });
}

}  // namespace m2m_transfer
