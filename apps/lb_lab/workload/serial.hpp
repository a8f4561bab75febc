// The oracle for workloads of cells, and their cost.
#pragma once

#include "apps/lb_lab/workload/workload.hpp"

namespace lb_lab {

/// All cells in a row, two time levels.
[[nodiscard]] std::uint64_t serial_answer_of_cells(const Problem& problem);

/// Seconds at speed 1 of all iterations of all cells.
[[nodiscard]] double total_seconds_of_cells(const Problem& problem);

}  // namespace lb_lab
