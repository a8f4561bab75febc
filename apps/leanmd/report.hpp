// What the program prints and writes about its runs.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/leanmd/simulation.hpp"

#include <optional>
#include <span>
#include <string>

namespace leanmd {

/// One run; `options` as the run left them.
struct Row {
  Options options;
  Outcome outcome;
  /// Of the drift, from the row before: 2 for velocity Verlet.
  std::optional<double> order{};
};

/// A study's table, and the JSON of all runs.
[[nodiscard]] const kit::Rows<Row>& report();
/// The order of the drift over all rows; none where fewer than two are stable.
[[nodiscard]] std::optional<double> fitted_order(std::span<const Row> rows);
/// Drift against run time, beside a line of order 2.
[[nodiscard]] kit::Chart chart_of(std::span<const Row> rows);

/// What this run does, step by step.
[[nodiscard]] std::string explain(const Options& options, std::int64_t n_atoms);
/// Energies, balance rounds and result of one run.
[[nodiscard]] std::string summary(const Row& row);

}  // namespace leanmd
