// The output of task_bench: the lines of Task Bench for a run, a table for METG, files.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/task_bench/experiment.hpp"

#include <string>
#include <vector>

namespace task_bench {

/// A row per case: the table of METG, and the JSON, in which a row has the grains that were measured.
[[nodiscard]] const kit::Rows<Result>& report();
/// "Total Tasks 16 …" as Task Bench prints it, and the efficiency.
[[nodiscard]] std::string run_text(const Result& result);

/// The sentence about its limits, as a line.
[[nodiscard]] std::string limits_text(const Result& result);

/// The features that a case uses and does not use.
[[nodiscard]] std::string explain(const Settings& settings);

/// A line per grain.
[[nodiscard]] std::string csv_of(const std::vector<Result>& results);
/// Efficiency against the grain, one line per case.
[[nodiscard]] kit::Chart chart_of(const std::vector<Result>& results);

}  // namespace task_bench
