#include "apps/m2m_transfer/output/drift.hpp"

#include "apps/kit/chart.hpp"
#include "apps/kit/json.hpp"
#include "apps/kit/quoting.hpp"
#include "apps/kit/write_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

bool several_fields(const Drift& drift) {
  return std::ranges::any_of(
      drift.rows, [&](const DriftRow& r) { return r.field != drift.rows.front().field; });
}

/// A line per kind and field.
kit::Chart chart_of(const Drift& drift, const std::string& quantity, double DriftRow::*value) {
  kit::Chart chart{.title = "drift over round trips",
                   .x_label = "round trips",
                   .y_label = quantity,
                   .x_log = true,
                   .y_log = true};
  for (const DriftRow& row : drift.rows) {
    const std::string name = row.kind + (several_fields(drift) ? ", " + row.field : std::string());
    auto at = std::ranges::find_if(chart.series,
                                   [&](const kit::Series& series) { return series.name == name; });
    if (at == chart.series.end()) {
      chart.series.push_back({name});
      at = chart.series.end() - 1;
    }
    at->points.push_back({static_cast<double>(row.trips), std::abs(row.*value)});
  }
  return chart;
}

}  // namespace

std::string table(const Drift& drift) {
  std::string out = fmt::format(
      "{} -> {} -> {}, one pair of handles\n  machine      {}\n  {:<22} {:<10} {:>6} {:>11} {:>11} "
      "{:>9} {:>17} {:>11}  {}\n",
      drift.source, drift.target, drift.source, drift.machine, "kind", "field", "trips", "L2",
      "Linf", "L2 kept", "integral", "change", "result");
  const DriftRow* last = nullptr;
  for (const DriftRow& row : drift.rows) {
    const bool same = last != nullptr && last->kind == row.kind;
    out += fmt::format(
        "  {:<22} {:<10} {:>6} {:>11.4e} {:>11.4e} {:>9.5f} {:>17.10g} {:>11.2e}  {:016x}\n",
        same ? "" : row.kind, row.field, row.trips, row.l2_relative, row.linf, row.l2_kept,
        row.integral, row.integral_change, row.hash);
    last = &row;
  }
  out +=
      "  L2, Linf: of the difference to the start (L2 relative); L2 kept: the norm as a part of "
      "that "
      "at the start;\n"
      "  integral: by the row sums of the mass matrix; change: as a part of the integral of "
      "|field|\n";
  return out;
}

std::string json(const Drift& drift) {
  kit::Json whole{{"source", drift.source},
                  {"target", drift.target},
                  {"policy", drift.policy},
                  {"machine", drift.machine}};
  whole["trip_seconds"] = drift.trip_seconds;
  for (const DriftRow& row : drift.rows)
    whole["rows"].push_back({{"kind", row.kind},
                             {"field", row.field},
                             {"trips", row.trips},
                             {"l2_relative", row.l2_relative},
                             {"linf", row.linf},
                             {"l2_kept", row.l2_kept},
                             {"integral", row.integral},
                             {"integral_change", row.integral_change},
                             {"result_hash", fmt::format("{:016x}", row.hash)}});
  return kit::json_text(whole);
}

std::string write(const Drift& drift, const std::string& folder) {
  std::string csv =
      "kind,field,trips,l2_relative,linf,l2_kept,integral,integral_change,result_hash\n";
  for (const DriftRow& row : drift.rows)
    csv += fmt::format("{},{},{},{},{},{},{},{},{:016x}\n", row.kind, kit::csv_field(row.field),
                       row.trips, row.l2_relative, row.linf, row.l2_kept, row.integral,
                       row.integral_change, row.hash);
  kit::write_file(folder + "/drift.csv", csv);
  kit::write_file(folder + "/drift.json", json(drift));
  bool drawn = kit::write_svg(
      folder + "/drift_l2.svg",
      chart_of(drift, "relative L2 difference to the start", &DriftRow::l2_relative));
  drawn = kit::write_svg(
              folder + "/drift_integral.svg",
              chart_of(drift, "relative change of the integral", &DriftRow::integral_change)) &&
          drawn;
  return fmt::format("written: {}/drift.csv, drift.json, drift_l2 and drift_integral as {}\n",
                     folder, drawn ? "svg and csv" : "csv");
}

}  // namespace m2m_transfer
