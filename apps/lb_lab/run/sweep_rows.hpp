// The rows of a sweep: what is measured of each run, for the reports.
#pragma once

#include "apps/lb_lab/run/settings.hpp"
#include "runtime/core/load_summary.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace lb_lab {

/// One run as a row of the table and of the JSON.
struct Row {
  std::string workload, strategy;
  std::int32_t per_pe = 0, n_pes = 0, n_iterations = 0;
  double seconds_total = 0, ideal_seconds = 0;
  std::vector<double> seconds_of_runs;  ///< of all repeats; the fastest is seconds_total
  double imbalance_before = 1;          ///< max/average of the iterations before the first round
  double imbalance_after = 1;           ///< of the later ones
  std::size_t n_moves = 0;
  std::uint64_t moved_bytes = 0;
  double balance_seconds = 0;
  double gain = 0;  ///< share of the time of `none` that is saved
  std::uint64_t answer = 0;
  tess::LoadSummary limits;
  std::vector<double> imbalance_of_iteration;
};

struct Sweep {
  Settings settings;
  std::function<void(const Row&)> on_row;  ///< called with each row; may be empty
  std::vector<Row> rows;
  std::string wrong;  ///< the first run with another answer than the serial one; empty: none
};

}  // namespace lb_lab
