// What nqueens prints and writes.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/nqueens/search.hpp"

#include <string>
#include <vector>

namespace nqueens {

/// One run: its efficiency is the time of one task on one PE, divided by PEs × its own time.
struct Row {
  Problem problem;
  Outcome outcome;
  double efficiency = 0;  ///< 0: unknown
};

[[nodiscard]] const kit::Rows<Row>& report();

/// Empty if the answer is right; `expected` is the number of solutions.
[[nodiscard]] std::string fault(const Row& row, std::uint64_t expected);

/// Efficiency against the number of tasks, a line per form.
[[nodiscard]] kit::Chart chart_of(const std::vector<Row>& rows);

}  // namespace nqueens
