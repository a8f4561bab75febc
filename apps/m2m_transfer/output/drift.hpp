// The drift over round trips as rows and pictures.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/m2m_transfer/output/folder.hpp"
#include "apps/m2m_transfer/run/drift.hpp"

#include <vector>

namespace m2m_transfer {

[[nodiscard]] const kit::Rows<DriftRow>& drift_rows();
/// The differences and the change of the integral against the number of trips.
[[nodiscard]] std::vector<Picture> pictures_of(const std::vector<DriftRow>& rows);

}  // namespace m2m_transfer
