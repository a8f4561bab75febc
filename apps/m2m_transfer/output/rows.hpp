// The errors and times of transfers as rows, one per pair of meshes and field: the table of --kind
// all and of studies, their CSV, and the JSON of every transfer.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/m2m_transfer/report.hpp"

#include <vector>

namespace m2m_transfer {

/// It refers to a report.
struct FieldRow {
  const TransferReport* report;
  const FieldError* field;
};

[[nodiscard]] std::vector<FieldRow> rows_of(const std::vector<TransferReport>& reports);
[[nodiscard]] const kit::Rows<FieldRow>& field_rows();
/// The meaning of the numbers, for the JSON.
[[nodiscard]] kit::Json definitions();

}  // namespace m2m_transfer
