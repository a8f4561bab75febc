// Balancing of an array in a run, for all kinds of workloads.
#pragma once

#include "apps/lb_lab/run/experiment.hpp"
#include "runtime/balance.hpp"

namespace lb_lab {

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

}  // namespace lb_lab
