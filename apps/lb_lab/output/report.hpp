// Reports of the laboratory: before the run an explanation, a table row per run, JSON at the end.
#pragma once

#include "apps/lb_lab/run/experiment.hpp"
#include "apps/lb_lab/run/sweep_rows.hpp"

#include <string>

namespace lb_lab {

void print_head();
void print_row(const Row& row);
/// The best cut and strategy of each workload.
void print_best(const Sweep& sweep);

/// Writes rows (the schema of the README), best, and imbalance over iterations. Throws tess::Error
/// where the file cannot be written.
void write_json(const std::string& path, const Sweep& sweep);

/// All workloads and strategies, a line each.
[[nodiscard]] std::string list_text();

/// What these settings use, and what they leave out.
[[nodiscard]] std::string explain_text(const Settings& settings, std::int32_t n_pes);

/// Writes the phases that a strategy was given, one file per PE:
/// DIR/WORKLOAD-PER_PE-STRATEGY/data.PE.json.br, or .json.
void save_snapshots(const Settings& settings, const Row& row, const Outcome& outcome);

}  // namespace lb_lab
