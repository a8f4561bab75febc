// Reports of the laboratory: before the run an explanation, a row per run, the best at the end.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/lb_lab/run/experiment.hpp"
#include "apps/lb_lab/run/sweep_rows.hpp"

#include <string>

namespace lb_lab {

[[nodiscard]] const kit::Rows<Row>& report();
/// The fastest row of a workload.
[[nodiscard]] const Row& best_of(const Sweep& sweep, const std::string& workload);
/// The best cut and strategy of each workload, a line each, and what limits it, and none there.
[[nodiscard]] std::string best_text(const Sweep& sweep);
/// Gives the same as rows of the JSON.
[[nodiscard]] kit::Json best_json(const Sweep& sweep);

/// All workloads and strategies, a line each.
[[nodiscard]] std::string list_text();

/// What these settings use, and what they leave out.
[[nodiscard]] std::string explain_text(const Settings& settings, std::int32_t n_pes);

/// Writes the phases that a strategy was given, one file per PE:
/// DIR/WORKLOAD-PER_PE-STRATEGY/data.PE.json.br, or .json.
void save_snapshots(const Settings& settings, const Row& row, const Outcome& outcome);

}  // namespace lb_lab
