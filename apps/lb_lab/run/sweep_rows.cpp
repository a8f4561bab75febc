#include "apps/lb_lab/run/sweep_rows.hpp"

namespace lb_lab {

const Row& best_of(const Sweep& sweep, const std::string& workload) {
  const Row* best = nullptr;
  for (const Row& row : sweep.rows)
    if (row.workload == workload && (best == nullptr || row.seconds_total < best->seconds_total))
      best = &row;
  return *best;
}

}  // namespace lb_lab
