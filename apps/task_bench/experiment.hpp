// Runs of task graphs on the machine: arrays of columns that are made once and run many times, and
// the search for METG over them.
#pragma once

#include "apps/task_bench/column.hpp"
#include "apps/task_bench/metg.hpp"
#include "apps/task_bench/settings.hpp"
#include "runtime/core/load_summary.hpp"

#include <functional>
#include <vector>

namespace task_bench {

/// The measurements of one case (graphs that run at once).
struct Result {
  std::vector<Graph> graphs;
  std::vector<Row> rows;
  std::optional<Metg> metg;
  tess::LoadSummary limits;  ///< of one run more, at the grain of METG or the last one
  std::vector<std::vector<tess::balance::Round>> rounds;  ///< per graph, where a balancer ran
};

/// Runs all cases, on PE 0, and reports each through `tell`. Ends the run with exit code 1 if the
/// columns did not run the tasks of the graphs.
tess::Task run_all(const Settings& settings, const std::function<void(const Result&)>& tell,
                   std::vector<Result>& results);

}  // namespace task_bench
