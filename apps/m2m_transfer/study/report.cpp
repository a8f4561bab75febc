#include "apps/m2m_transfer/study/study.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
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
  return {"order 2", {{low, c * low * low}, {high, c * high * high}}, kit::Style::dashes};
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

}  // namespace m2m_transfer
