#include "apps/m2m_transfer/study/checks.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

/// The least order that is no failure, a quarter below the order of the kind for smooth fields.
double least_order(const std::string& kind) {
  if (kind == "second-order") return 2.75;
  if (kind == "linear" || kind == "limited" || kind == "conservative") return 1.75;
  return 0.75;
}

bool is_smooth(const std::string& field) {
  return field == "gaussian" || field == "sin";
}

/// The two rows of a trend with the shortest edges, the finest first.
std::vector<FieldRow> finest_two(const std::vector<FieldRow>& rows, const Trend& trend) {
  std::vector<FieldRow> out;
  for (const FieldRow& row : rows)
    if (trend.has(row) && row.report->tally.counts[3] == 0) out.push_back(row);
  std::ranges::sort(out, {}, [](const FieldRow& row) { return row.report->source_edge; });
  if (out.size() > 2) out.resize(2);
  return out;
}

}  // namespace

std::vector<Check> checks(const std::vector<TransferReport>& reports) {
  std::vector<Check> out;
  const std::vector<FieldRow> rows = rows_of(reports);
  for (const auto& [r, field] : rows) {
    if (!field->bound || field->found.n_vertices == 0) continue;
    // Values up to about ten, and coordinates in the formula, round.
    const double rounding = 1e-12 + 1e-9 * *field->bound;
    out.push_back({fmt::format("{}, {} -> {}, {}: Linf at most (3/16) h^2 max|D2f|", r->kind,
                               r->source, r->target, field->name),
                   field->found.linf, *field->bound + rounding});
  }
  for (const Trend& trend : trends(reports)) {
    if (trend.exact || !is_smooth(trend.field)) continue;
    const std::vector<FieldRow> two = finest_two(rows, trend);
    if (two.size() < 2) continue;
    const TransferReport &fine = *two[0].report, &coarse = *two[1].report;
    if (fine.source_edge > 0.9 * coarse.source_edge) continue;
    const double order = std::log(two[1].field->norms.l2 / two[0].field->norms.l2) /
                         std::log(coarse.source_edge / fine.source_edge);
    out.push_back({fmt::format("{}, {} to {}, {}: order of L2 at least", trend.kind, coarse.source,
                               fine.source, trend.field),
                   order, least_order(trend.kind), false});
  }
  return out;
}

const kit::Rows<Check>& check_rows() {
  using kit::of;
  static constexpr kit::Column<Check> columns[] = {
      {"what", "check", "<", of<&Check::what>},
      {"limit", "limit", "11.4e", of<&Check::limit>},
      {"value", "measured", "11.4e", of<&Check::value>},
      {"ok", "", nullptr, [](const Check& check) -> kit::Json { return check.ok(); }},
      {"", "", "<", [](const Check& check) -> kit::Json { return check.ok() ? "ok" : "FAILED"; }}};
  static const kit::Rows<Check> rows(columns);
  return rows;
}

std::string failures(const std::vector<Check>& checks) {
  std::string out;
  bool an_order = false;
  for (const Check& check : checks) {
    if (check.ok()) continue;
    out += fmt::format("FAILED: {}: claimed {:.4e}, measured {:.4e}\n", check.what, check.limit,
                       check.value);
    an_order = an_order || !check.at_most;
  }
  if (an_order)
    out +=
        "an order is claimed of meshes that resolve the field; give a ladder of finer ones, such "
        "as "
        "kuhn:16,32\n";
  return out;
}

}  // namespace m2m_transfer
