// The rows of a scaling study of a transfer: as a table, CSV and a chart.
#pragma once

#include "apps/m2m_transfer/report.hpp"
#include "m2m/tally.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace m2m_scaling {

/// A machine.
struct Row {
  std::int32_t pes = 0;
  m2m_transfer::PhaseSeconds seconds;
  tess::m2m::Tally tally;
  std::uint64_t result_hash = 0;
};

/// Set-up, search and one application: the values are at the pieces of the target.
[[nodiscard]] double distributed_seconds(const Row& row);
/// With the values of all vertices collected on PE 0.
[[nodiscard]] double gathered_seconds(const Row& row);

[[nodiscard]] std::string head();
/// Efficiency is against `first`, the row with the fewest PEs.
[[nodiscard]] std::string line(const Row& row, const Row& first);

/// Writes the seconds of each phase against the number of PEs to PREFIX.svg and PREFIX.csv.
void draw(const std::string& prefix, const std::string& title, const std::vector<Row>& rows);

}  // namespace m2m_scaling
