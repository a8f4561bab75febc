#include "apps/kit/chart.hpp"
#include "apps/kit/quoting.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/m2m_transfer/output/table.hpp"
#include "apps/m2m_transfer/study/checks.hpp"
#include "apps/m2m_transfer/study/study.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace m2m_transfer {
namespace {

using Text = std::back_insert_iterator<std::string>;

std::string power(const std::optional<double>& exponent) {
  return exponent ? fmt::format("{:.2f}", *exponent) : std::string("-");
}

bool several_policies(const Study& study) {
  return study.reports.front().policy != study.reports.back().policy;
}
bool several_kinds(const Study& study) {
  return study.reports.front().kind != study.reports.back().kind;
}

/// ", KIND, POLICY", as far as the study has several.
std::string variant(const Study& study, const std::string& kind, const std::string& policy) {
  return (several_kinds(study) ? ", " + kind : std::string()) +
         (several_policies(study) ? ", " + policy : std::string());
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

enum class Against { seconds, edge };

kit::Chart chart_of(const Study& study, Against against) {
  kit::Chart chart{
      .title = against == Against::seconds ? "transfer: error against run time"
                                           : "transfer: error against the source's edge length",
      .x_label = against == Against::seconds
                     ? fmt::format("seconds per transfer, PEs: {}", study.reports.front().pes)
                     : "edge length of the source",
      .y_label = "error",
      .x_log = true,
      .y_log = true};
  std::size_t at = 0;
  for (const Trend& trend : trends(study)) {
    const std::size_t f = at++ % study.reports.front().fields.size();
    if (trend.exact) continue;  // rounding errors would dominate the axis
    const std::string name = trend.field + variant(study, trend.kind, trend.policy);
    kit::Series l2{name + ": L2"}, linf{name + ": Linf"};
    for (const TransferReport& r : study.reports) {
      if (r.policy != trend.policy || r.kind != trend.kind) continue;
      const double x = against == Against::seconds ? r.seconds.transfer() : r.source_edge;
      l2.points.push_back({x, r.fields[f].norms.l2});
      linf.points.push_back({x, r.fields[f].norms.linf});
    }
    chart.series.push_back(std::move(l2));
    chart.series.push_back(std::move(linf));
  }
  if (against == Against::edge) {
    for (const TransferReport& r : study.reports) chart.x_ticks.push_back(r.source_edge);
    sort_unique(chart.x_ticks);
    if (kit::Series line = second_order(chart); !line.points.empty())
      chart.series.push_back(std::move(line));
  }
  return chart;
}

}  // namespace

std::string table(const Study& study) {
  const TransferReport& any = study.reports.front();
  std::string out =
      fmt::format("study of {} transfers, each the fastest of {}\n  machine      {}\n",
                  study.reports.size(), study.repeat, any.machine);
  std::size_t wide = 6;
  for (const TransferReport& r : study.reports)
    wide = std::max({wide, r.source.size(), r.target.size()});
  const bool variants = several_policies(study) || several_kinds(study);
  Text to(out);
  fmt::format_to(to,
                 "  {:<{}} {:<{}} {:>9} {:>9} {:>9} {:>8}  {:<10} {:>11} {:>11} {:>11} {:>11}{}\n",
                 "source", wide, "target", wide, "edge", "setup", "transfer", "outside", "field",
                 "L2", "Linf", "L2 found", "Linf found", variants ? "  variant" : "");
  for (const TransferReport& r : study.reports) {
    for (const FieldError& field : r.fields) {
      const bool first = &field == &r.fields.front();
      if (first)
        fmt::format_to(to, "  {:<{}} {:<{}} {:>9.4g} {:>9.4f} {:>9.4f} {:>8}", r.source, wide,
                       r.target, wide, r.source_edge, r.seconds.setup, r.seconds.transfer(),
                       r.tally.counts[3]);
      else
        fmt::format_to(to, "{:{}}", "", 2 * wide + 42);
      fmt::format_to(to, "  {:<10} {:>11.4e} {:>11.4e} {:>11.4e} {:>11.4e}{}\n", field.name,
                     field.norms.l2, field.norms.linf, field.found.l2, field.found.linf,
                     variants ? "  " + variant(study, r.kind, r.policy).substr(2) : std::string());
    }
  }
  out +=
      "L2: sqrt(sum m e^2), m the lumped mass; Linf: max |e|; over all vertices of the target, and "
      "over those found\n";
  fmt::format_to(to,
                 "fitted powers (over all): error ~ edge^p, error ~ seconds^q\n  {:<34} {:>8} "
                 "{:>8} {:>10} {:>10}\n",
                 "field", "p(L2)", "p(Linf)", "q(L2)", "q(Linf)");
  for (const Trend& t : trends(study)) {
    const std::string name = t.field + variant(study, t.kind, t.policy);
    if (t.exact)
      fmt::format_to(to, "  {:<34} exact: relative L2 below 1e-12 everywhere\n", name);
    else
      fmt::format_to(to, "  {:<34} {:>8} {:>8} {:>10} {:>10}\n", name, power(t.l2_of_edge),
                     power(t.linf_of_edge), power(t.l2_of_seconds), power(t.linf_of_seconds));
  }
  return out;
}

std::string json(const Study& study) {
  kit::Json whole = json_of(study.reports);
  whole["repeat"] = study.repeat;
  whole["trends"] = kit::Json::array();
  const auto number = [](const std::optional<double>& value) {
    return value ? kit::Json(*value) : kit::Json();
  };
  for (const Trend& t : trends(study))
    whole["trends"].push_back({{"field", t.field},
                               {"kind", t.kind},
                               {"policy", t.policy},
                               {"exact", t.exact},
                               {"l2_of_edge", number(t.l2_of_edge)},
                               {"linf_of_edge", number(t.linf_of_edge)},
                               {"l2_of_seconds", number(t.l2_of_seconds)},
                               {"linf_of_seconds", number(t.linf_of_seconds)}});
  for (const Check& check : study.is_checked ? checks(study) : std::vector<Check>())
    whole["checks"].push_back(
        {{"what", check.what}, {"value", check.value}, {"limit", check.limit}, {"ok", check.ok()}});
  return kit::json_text(whole);
}

std::string csv(const Study& study) {
  std::string out =
      "source,target,kind,policy,field,edge,source_tets,targets,inside,boundary,snapped,outside,l2,"
      "l2_relative,rms,linf,l2_found,l2_relative_found,rms_found,linf_found,candidates,setup,broad,"
      "narrow,apply,transfer,bytes_sent,pes,"
      "processes,result_hash\n";
  for (const TransferReport& r : study.reports)
    for (const FieldError& field : r.fields)
      fmt::format_to(
          Text(out),
          "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}"
          ",{},{},{:016x}\n",
          kit::csv_field(r.source), kit::csv_field(r.target), r.kind, kit::csv_field(r.policy),
          kit::csv_field(field.name), r.source_edge, r.source_tets, r.targets, r.tally.counts[0],
          r.tally.counts[1], r.tally.counts[2], r.tally.counts[3], field.norms.l2,
          field.norms.l2_relative, field.norms.rms, field.norms.linf, field.found.l2,
          field.found.l2_relative, field.found.rms, field.found.linf, r.tally.n_candidates,
          r.seconds.setup, r.seconds.broad, r.seconds.narrow, r.seconds.apply, r.seconds.transfer(),
          r.footprint.bytes_sent, r.pes, r.processes, r.result_hash);
  return out;
}

std::string write(const Study& study, const std::string& folder) {
  const std::string stem = folder + "/";
  kit::write_file(stem + "study.csv", csv(study));
  kit::write_file(stem + "study.json", json(study));
  bool drawn = kit::write_svg(stem + "error_time.svg", chart_of(study, Against::seconds));
  drawn = kit::write_svg(stem + "error_edge.svg", chart_of(study, Against::edge)) && drawn;
  return fmt::format("written: {}study.csv, study.json, error_time and error_edge as {}\n", stem,
                     drawn ? "svg and csv" : "csv");
}

}  // namespace m2m_transfer
