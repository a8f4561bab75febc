// One run of the laboratory: one workload, one cut, one strategy, an array of its own.
#pragma once

#include "apps/lb_lab/run/station.hpp"
#include "runtime/balance.hpp"
#include "runtime/balance/datafile/lb_datafile.hpp"
#include "runtime/balance_options.hpp"
#include "runtime/core/load_summary.hpp"
#include "runtime/task.hpp"

#include <cstdint>
#include <vector>

namespace lb_lab {

enum class Keep : std::uint8_t { nothing, snapshots };

struct Experiment {
  Plan plan;
  tess::BalanceOptions balance;  ///< strategy none: no balancer is made
  Keep keep = Keep::nothing;
};

struct Outcome {
  double began = 0;    ///< on PE 0's clock
  double seconds = 0;  ///< from the first message to the answer
  std::vector<double> seconds_of_runs;
  std::uint64_t answer = 0;
  std::vector<PeRecord> records;  ///< of each PE
  std::vector<tess::PeLoad> loads;
  std::vector<tess::balance::Round> rounds;
  std::vector<tess::balance::Phase> phases;  ///< snapshots given to the strategy, if they are kept
};

[[nodiscard]] inline bool balances(const Experiment& experiment) {
  return experiment.balance.strategy != "none";
}

/// The strategy of the options, which also records the snapshots that it is given.
[[nodiscard]] tess::balance::Strategy noting(const tess::BalanceOptions& options,
                                             std::vector<tess::balance::Phase>& phases);

/// Starts balancing, inside an epoch of the caller. Both references outlive the run.
template <class C>
[[nodiscard]] tess::BalancerProxy start_balancing(tess::ArrayProxy<C> array,
                                                  const Experiment& experiment, Outcome& outcome) {
  // A distributed strategy is given no snapshot; another one in its place would not be it.
  if (experiment.keep == Keep::nothing ||
      tess::balance::is_distributed(experiment.balance.strategy))
    return tess::start_balancing(array, experiment.balance);
  return tess::start_balancing(array, experiment.balance,
                               noting(experiment.balance, outcome.phases));
}

/// Runs it to its end; PE 0 awaits it. Both arguments outlive the run.
tess::Task run(const Experiment& experiment, Outcome& outcome);

/// max/average of PE time over the iterations [first, last): the sum of the slowest PE over that of
/// all, weighted by their speeds.
[[nodiscard]] double imbalance(const Outcome& outcome, const Plan& plan, std::int32_t first,
                               std::int32_t last);

/// Seconds that the run would take if work were a fluid: measured work over all speeds.
[[nodiscard]] double ideal_seconds(const Outcome& outcome, const Plan& plan);

/// Rounds as intervals on the clock of the run, per PE: they begin when the last of all elements
/// has reached the barrier, and end when the first on this PE goes on. Without a barrier: by PE 0.
[[nodiscard]] std::vector<std::vector<Interval>> balancing_times(const Outcome& outcome);

}  // namespace lb_lab
