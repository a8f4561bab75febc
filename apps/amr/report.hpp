// What amr prints and writes.
#pragma once

#include "apps/amr/simulate.hpp"
#include "apps/plot/chart.hpp"
#include "apps/plot/json.hpp"

#include <string>
#include <vector>

namespace amr {

struct Row {
  Settings settings;
  Outcome outcome;
};

[[nodiscard]] std::string head();
[[nodiscard]] std::string line(const Row& row);
/// Empty if the mass is what it was, to the quantum.
[[nodiscard]] std::string fault(const Outcome& outcome);

[[nodiscard]] plot::Json json_of(const std::vector<Row>& rows);
/// Error against run time, a line per order; and uniform trees of order 2.
[[nodiscard]] plot::Chart chart_of(const std::vector<Row>& rows);

}  // namespace amr
