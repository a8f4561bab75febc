// What amr prints and writes.
#pragma once

#include "apps/amr/simulate.hpp"

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

void write_json(const std::string& path, const std::vector<Row>& rows, const std::string& machine);
/// Error against run time, a line per order; and uniform trees of order 2.
void draw(const std::string& path, const std::vector<Row>& rows);

}  // namespace amr
