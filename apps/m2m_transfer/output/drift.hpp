// The drift over round trips as a table, JSON, CSV and pictures.
#pragma once

#include "apps/m2m_transfer/run/drift.hpp"

#include <string>

namespace m2m_transfer {

[[nodiscard]] std::string table(const Drift& drift);
[[nodiscard]] std::string json(const Drift& drift);
/// Writes drift.csv, drift.json, drift_l2.svg and drift_integral.svg into an existing folder.
/// Returns a line that lists them.
[[nodiscard]] std::string write(const Drift& drift, const std::string& folder);

}  // namespace m2m_transfer
