// The rows of a scaling study of a transfer: as a table, CSV and a chart.
#pragma once

#include "apps/m2m_transfer/report.hpp"

#include <string>
#include <vector>

namespace m2m_scaling {

using m2m_transfer::TransferReport;

/// Set-up, search and one application: the values are at the pieces of the target.
[[nodiscard]] double distributed_seconds(const TransferReport& row);
/// With the values of all vertices collected on PE 0.
[[nodiscard]] double gathered_seconds(const TransferReport& row);

[[nodiscard]] std::string head();
/// Efficiency is against `first`, the row with the fewest PEs.
[[nodiscard]] std::string line(const TransferReport& row, const TransferReport& first);

/// Writes the seconds of each phase against the number of PEs to PREFIX.svg and PREFIX.csv.
void draw(const std::string& prefix, const std::vector<TransferReport>& rows);

}  // namespace m2m_scaling
