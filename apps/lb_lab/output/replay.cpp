#include "apps/lb_lab/output/replay.hpp"

#include "runtime/balance/fold.hpp"
#include "runtime/balance/lb_datafile.hpp"
#include "runtime/balance/metrics.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace lb_lab {
namespace {

using tess::balance::Snapshot;

/// As the files have it, or on as many PEs and of such speeds as the options say.
Snapshot prepared(const Settings& s, Snapshot snapshot) {
  const auto n_pes =
      s.replay_pes > 0 ? static_cast<std::size_t>(s.replay_pes) : snapshot.pes.size();
  snapshot = tess::balance::fold(std::move(snapshot), n_pes, tess::balance::parse_fold(s.fold));
  if (s.speeds.empty()) return snapshot;
  if (s.speeds.size() != n_pes)
    tess::fail(tess::ErrorCode::bad_argument, "--speed: ", s.speeds.size(),
               " speeds for a replay on ", n_pes, " PEs; give one per PE");
  snapshot.pes.speed = s.speeds;
  tess::balance::validate(snapshot);
  return snapshot;
}

std::string row(std::uint64_t phase, const Snapshot& snapshot, const std::string& name,
                std::uint64_t seed) {
  const tess::balance::Strategy strategy = tess::balance::make_strategy(name, seed);
  const auto began = std::chrono::steady_clock::now();
  const tess::balance::Assignment wanted = strategy(snapshot);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - began;
  const tess::balance::Metrics before = measure(snapshot, snapshot.elements.pe);
  const tess::balance::Metrics after = measure(snapshot, wanted);
  return fmt::format("{:>6} {:>6} {:>9} {:<14} {:>8.3f} {:>9.3f} {:>8} {:>12} {:>14} {:>12.3f}\n",
                     phase, snapshot.pes.size(), snapshot.elements.size(), name,
                     before.max_over_average, after.max_over_average, after.n_moves,
                     after.moved_bytes, after.external_bytes, took.count());
}

}  // namespace

std::string replay(const Settings& s) {
  (void)tess::balance::parse_fold(s.fold);  // before files are read
  std::vector<std::string> names = s.strategies;
  if (std::ranges::count(names, "all") > 0) names = tess::balance::strategy_names();
  std::string out = fmt::format("{:>6} {:>6} {:>9} {:<14} {:>8} {:>9} {:>8} {:>12} {:>14} {:>12}\n",
                                "phase", "PEs", "elements", "strategy", "before", "predicted",
                                "moves", "bytes", "external bytes", "strategy ms");
  for (tess::balance::Phase& phase : tess::balance::read_lb_datafiles(s.replay)) {
    const Snapshot snapshot = prepared(s, std::move(phase.snapshot));
    for (const std::string& name : names) out += row(phase.id, snapshot, name, s.seed);
  }
  return out;
}

}  // namespace lb_lab
