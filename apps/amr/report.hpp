// What amr prints and writes of its runs.
#pragma once

#include "apps/amr/simulate.hpp"
#include "apps/kit/rows.hpp"

#include <string>
#include <vector>

namespace amr {

struct Row {
  Settings settings;
  Outcome outcome;
};

[[nodiscard]] const kit::Rows<Row>& report();
/// Empty if the mass is what it was, to the quantum.
[[nodiscard]] std::string fault(const Outcome& outcome);
/// Error against run time, a line per order; and uniform trees of order 2.
[[nodiscard]] kit::Chart chart_of(const std::vector<Row>& rows);

}  // namespace amr
