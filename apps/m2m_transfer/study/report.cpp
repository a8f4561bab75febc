#include "apps/m2m_transfer/study/study.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

using Reports = std::vector<TransferReport>;

double run_time(const FieldRow& row) {
  return row.report->seconds.transfer();
}
double source_edge(const FieldRow& row) {
  return row.report->source_edge;
}

/// A line of slope 2 below all points of the chart, as a reference for second order.
kit::Series second_order(const kit::Chart& chart) {
  double low = 0, high = 0, c = 0;
  for (const kit::Series& series : chart.series) {
    for (const kit::Point& p : series.points) {
      if (!(p.x > 0) || !(p.y > 0)) continue;
      low = low == 0 ? p.x : std::min(low, p.x);
      high = std::max(high, p.x);
      const double at = p.y / (p.x * p.x);
      c = c == 0 ? at : std::min(c, at);
    }
  }
  if (c == 0) return {};
  c *= 0.7;
  return {"order 2", {{low, c * low * low}, {high, c * high * high}}, {}, kit::Style::dashes};
}

kit::Chart chart_of(const Reports& reports, const std::string& title, const std::string& x_label,
                    double (*x)(const FieldRow&)) {
  kit::Chart chart{
      .title = title, .x_label = x_label, .y_label = "error", .x_log = true, .y_log = true};
  const TransferReport &first = reports.front(), &last = reports.back();
  for (const Trend& trend : trends(reports)) {
    if (trend.exact) continue;  // rounding errors would dominate the axis
    const std::string name = trend.field + (first.kind != last.kind ? ", " + trend.kind : "") +
                             (first.policy != last.policy ? ", " + trend.policy : "");
    for (const FieldRow& row : rows_of(reports)) {
      if (!trend.has(row)) continue;
      kit::add_point(chart, name + ": L2", x(row), row.field->norms.l2);
      kit::add_point(chart, name + ": Linf", x(row), row.field->norms.linf);
    }
  }
  return chart;
}

/// The least order that is no failure, a quarter below the order of the kind for smooth fields.
double least_order(const std::string& kind) {
  if (kind == "second-order") return 2.75;
  if (kind == "linear" || kind == "limited" || kind == "conservative" || kind == "projection")
    return 1.75;
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

bool Trend::has(const FieldRow& row) const {
  return row.field->name == field && row.report->kind == kind && row.report->policy == policy;
}

std::vector<Trend> trends(const Reports& reports) {
  std::vector<Trend> all;
  const std::vector<FieldRow> rows = rows_of(reports);
  for (const FieldRow& first : rows) {
    if (std::ranges::any_of(all, [&](const Trend& before) { return before.has(first); })) continue;
    Trend trend{first.field->name, first.report->kind, first.report->policy, true};
    std::vector<FieldRow> its;
    for (const FieldRow& row : rows) {
      if (!trend.has(row)) continue;
      its.push_back(row);
      trend.exact = trend.exact && row.field->norms.l2_relative < 1e-12;
    }
    const auto order = [&](double (*x)(const FieldRow&), double ErrorNorms::*norm) {
      std::vector<double> xs, ys;
      for (const FieldRow& row : its) xs.push_back(x(row)), ys.push_back(row.field->norms.*norm);
      return trend.exact ? std::nullopt : kit::fitted_order(xs, ys);
    };
    trend.l2_of_edge = order(source_edge, &ErrorNorms::l2);
    trend.linf_of_edge = order(source_edge, &ErrorNorms::linf);
    trend.l2_of_seconds = order(run_time, &ErrorNorms::l2);
    trend.linf_of_seconds = order(run_time, &ErrorNorms::linf);
    all.push_back(std::move(trend));
  }
  return all;
}

const kit::Rows<Trend>& trend_rows() {
  using kit::of;
  static constexpr kit::Column<Trend> columns[] = {
      {"field", "field", "<", of<&Trend::field>},
      {"l2_of_edge", "p(L2)", "7.2f", of<&Trend::l2_of_edge>},
      {"linf_of_edge", "p(Linf)", "7.2f", of<&Trend::linf_of_edge>},
      {"l2_of_seconds", "q(L2)", "7.2f", of<&Trend::l2_of_seconds>},
      {"linf_of_seconds", "q(Linf)", "7.2f", of<&Trend::linf_of_seconds>},
      {"exact", "exact", "<", of<&Trend::exact>},
      {"kind", "kind", "<", of<&Trend::kind>},
      {"policy", "policy", "<", of<&Trend::policy>}};
  static const kit::Rows<Trend> rows(columns);
  return rows;
}

std::vector<Picture> pictures_of(const Reports& reports) {
  kit::Chart by_edge = chart_of(reports, "transfer: error against the source's edge length",
                                "edge length of the source", source_edge);
  for (const TransferReport& r : reports) by_edge.x_ticks.push_back(r.source_edge);
  sort_unique(by_edge.x_ticks);
  if (kit::Series line = second_order(by_edge); !line.points.empty())
    by_edge.series.push_back(std::move(line));
  return {{"error_time",
           chart_of(reports, "transfer: error against run time",
                    fmt::format("seconds per transfer, PEs: {}", reports.front().pes), run_time)},
          {"error_edge", std::move(by_edge)}};
}

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
