// Pictures of one workload: time against chares per PE, imbalance over iterations, and the activity
// of PEs before and after the first rounds.
#pragma once

#include "apps/kit/output/chart.hpp"
#include "apps/kit/output/timeline.hpp"
#include "apps/lb_lab/run/experiment.hpp"
#include "apps/lb_lab/run/sweep_rows.hpp"

#include <string>

namespace lb_lab {

class Drawings {
 public:
  explicit Drawings(std::string workload) : workload_(std::move(workload)) {}

  void add(const Outcome& outcome, const Row& row);

  /// Into a directory: WORKLOAD-time.svg, WORKLOAD-imbalance.svg of the best cut,
  /// WORKLOAD-timeline-none.svg and -timeline-STRATEGY.svg of the best cut and strategy.
  void write(const std::string& directory) const;

 private:
  struct Run {
    Row row;
    kit::Timeline timeline;
  };
  std::string workload_;
  std::vector<Run> runs_;
};

}  // namespace lb_lab
