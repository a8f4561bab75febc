#include "apps/lb_lab/run/sweep_rows.hpp"

namespace lb_lab {

std::vector<Row> best_of(const Sweep& sweep) {
  std::vector<Row> best;
  for (const Row& row : sweep.rows)
    if (best.empty() || best.back().workload != row.workload)
      best.push_back(row);
    else if (row.seconds_total < best.back().seconds_total)
      best.back() = row;
  return best;
}

}  // namespace lb_lab
