// Runs of task graphs on the machine: arrays of columns that are made once and run many times, and
// the search for METG over them.
#pragma once

#include "apps/task_bench/column.hpp"
#include "apps/task_bench/metg.hpp"
#include "apps/task_bench/settings.hpp"

#include <vector>

namespace task_bench {

/// What was measured of one case (graphs at once).
struct Result {
  std::vector<Graph> graphs;
  std::vector<Row> rows;
  std::optional<Metg> metg;
  std::vector<tess::balance::Round> rounds;  ///< of all graphs, where a balancer ran
};

/// Runs all cases, on PE 0, and reports each through `tell`. Ends the run with exit code 1 where
/// the columns did not run what the graphs have.
tess::Task run_all(const Settings& settings, void (*tell)(const Settings&, const Result&),
                   std::vector<Result>& results);

}  // namespace task_bench
