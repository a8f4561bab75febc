// Runs of workloads whose iterations end on all PEs at the same time: epochs close each iteration,
// and rounds of the balancer come between two of them. For chares that come and go.
//
//     iteration, its epochs │ the stations record it │ every period: a round │ iteration …
#pragma once

#include "apps/lb_lab/run/experiment.hpp"
#include "runtime/balance.hpp"

namespace lb_lab {

/// One such workload. PE 0 calls it.
class Stepped {
 public:
  Stepped(const Experiment& experiment, tess::GroupProxy<Station> stations, Outcome& outcome)
      : experiment_(experiment), stations_(stations), outcome_(outcome) {}
  Stepped(const Stepped&) = delete;
  Stepped& operator=(const Stepped&) = delete;
  virtual ~Stepped() = default;

  /// Makes the arrays, called in an epoch. The balancer is empty where the experiment has none.
  virtual tess::BalancerProxy create() = 0;
  /// Creates the chares of the first iteration.
  virtual tess::Task begin() = 0;
  virtual tess::Task step(std::int32_t iteration) = 0;
  /// All chares give their part of the answer to the station of their PE, and end.
  virtual tess::Task end() = 0;

  /// Runs it, and fills the outcome except for the records.
  tess::Task run();

 protected:
  const Experiment& experiment_;
  const tess::GroupProxy<Station> stations_;
  Outcome& outcome_;
};

/// Kind::run of such a workload.
template <class Workload>
tess::Task run_stepped(const Experiment& experiment, tess::GroupProxy<Station> stations,
                       Outcome& outcome) {
  Workload workload(experiment, stations, outcome);
  co_await workload.run();
}

}  // namespace lb_lab
