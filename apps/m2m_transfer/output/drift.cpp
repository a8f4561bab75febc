#include "apps/m2m_transfer/output/drift.hpp"

#include <algorithm>
#include <cmath>

namespace m2m_transfer {
namespace {

/// A line per kind and field.
Picture picture_of(const std::vector<DriftRow>& rows, const char* name, const char* quantity,
                   double DriftRow::*value) {
  kit::Chart chart{.title = "drift over round trips",
                   .x_label = "round trips",
                   .y_label = quantity,
                   .x_log = true,
                   .y_log = true};
  const bool several = std::ranges::any_of(
      rows, [&](const DriftRow& row) { return row.field != rows.front().field; });
  for (const DriftRow& row : rows)
    kit::add_point(chart, row.kind + (several ? ", " + row.field : ""), row.trips,
                   std::abs(row.*value));
  return {name, chart};
}

}  // namespace

const kit::Rows<DriftRow>& drift_rows() {
  using R = const DriftRow&;
  using kit::Json;
  using kit::of;
  static constexpr kit::Column<DriftRow> columns[] = {
      {"kind", "kind", "<", of<&DriftRow::kind>},
      {"field", "field", "<", of<&DriftRow::field>},
      {"trips", "trips", "5", of<&DriftRow::trips>},
      {"l2_relative", "L2", "10.4e", of<&DriftRow::l2_relative>},
      {"linf", "Linf", "10.4e", of<&DriftRow::linf>},
      {"l2_kept", "L2 kept", "8.5f", of<&DriftRow::l2_kept>},
      {"integral", "integral", "16.10g", of<&DriftRow::integral>},
      {"integral_change", "change", "9.2e", of<&DriftRow::integral_change>},
      {"result_hash", "result", "16", [](R r) -> Json { return kit::hex(r.hash); }}};
  static const kit::Rows<DriftRow> rows(columns);
  return rows;
}

std::vector<Picture> pictures_of(const std::vector<DriftRow>& rows) {
  return {
      picture_of(rows, "drift_l2", "relative L2 difference to the start", &DriftRow::l2_relative),
      picture_of(rows, "drift_integral", "relative change of the integral",
                 &DriftRow::integral_change)};
}

}  // namespace m2m_transfer
