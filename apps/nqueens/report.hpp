// What nqueens prints and writes.
#pragma once

#include "apps/nqueens/search.hpp"
#include "apps/plot/chart.hpp"
#include "apps/plot/json.hpp"

#include <string>
#include <vector>

namespace nqueens {

/// One run: its efficiency is the time of one task on one PE, divided by PEs × its own time.
struct Row {
  Problem problem;
  Outcome outcome;
  double efficiency = 0;  ///< 0: unknown
};

[[nodiscard]] std::string head();
[[nodiscard]] std::string line(const Row& row);

/// Empty if the answer is right; `expected` is the number of solutions.
[[nodiscard]] std::string fault(const Row& row, std::uint64_t expected);

[[nodiscard]] plot::Json json_of(const std::vector<Row>& rows);
/// Efficiency against the number of tasks, a line per form.
[[nodiscard]] plot::Chart chart_of(const std::vector<Row>& rows);

}  // namespace nqueens
