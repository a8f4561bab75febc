// The output of task_bench: the lines of Task Bench for a run, a table for METG, files.
#pragma once

#include "apps/task_bench/experiment.hpp"

#include <string>
#include <vector>

namespace task_bench {

/// "Total Tasks 16 …" as Task Bench prints it, and the efficiency; or a line of the METG table.
void print_result(const Settings& settings, const Result& result);
void print_head(const Settings& settings, const tess::Machine& machine);

/// The features that a case uses and does not use.
[[nodiscard]] std::string explain(const Settings& settings);

void write_json(const std::string& path, const std::vector<Result>& results,
                const std::string& machine);
void write_csv(const std::string& path, const std::vector<Result>& results);
/// Efficiency against the grain, one line per case.
void draw(const std::string& path, const std::vector<Result>& results);

}  // namespace task_bench
