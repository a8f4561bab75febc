// One transfer by every kind, as a table.
#pragma once

#include "apps/m2m_transfer/report.hpp"

#include <string>
#include <vector>

namespace m2m_transfer {

/// A row per kind, pair and field: vertices outside, errors over all vertices, the change of
/// the integral, the time of the search and of an application, and the hash of the pair's result.
/// `reports`: of all pairs by one kind, then by the next.
[[nodiscard]] std::string kinds_table(const std::vector<TransferReport>& reports);

}  // namespace m2m_transfer
