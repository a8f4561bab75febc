#include "apps/m2m_scaling/report.hpp"

#include "apps/kit/chart.hpp"

#include <fmt/format.h>
#include <functional>

namespace m2m_scaling {
namespace {

double efficiency(double seconds, const Row& row, double first_seconds, const Row& first) {
  return first_seconds * first.pes / (seconds * row.pes);
}

}  // namespace

double distributed_seconds(const Row& row) {
  return row.seconds.setup + row.seconds.transfer();
}

double gathered_seconds(const Row& row) {
  return distributed_seconds(row) + row.seconds.gather;
}

std::string head() {
  return "| PEs | set-up | broad | narrow | apply | together | efficiency | gather | with "
         "gathering "
         "| efficiency |\n|---|---|---|---|---|---|---|---|---|---|\n";
}

std::string line(const Row& row, const Row& first) {
  const m2m_transfer::PhaseSeconds& s = row.seconds;
  const double here = distributed_seconds(row), gathered = gathered_seconds(row);
  return fmt::format(
      "| {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {:.0f} % | {:.4f} | {:.4f} | {:.0f} % "
      "|\n",
      row.pes, s.setup, s.broad, s.narrow, s.apply, here,
      100 * efficiency(here, row, distributed_seconds(first), first), s.gather, gathered,
      100 * efficiency(gathered, row, gathered_seconds(first), first));
}

void draw(const std::string& prefix, const std::string& title, const std::vector<Row>& rows) {
  kit::Chart chart{
      .title = title, .x_label = "PEs", .y_label = "seconds", .x_log = true, .y_log = true};
  for (const Row& row : rows) chart.x_ticks.push_back(row.pes);
  const auto add = [&](const char* name, const std::function<double(const Row&)>& of,
                       kit::Style style = kit::Style::lines_points) {
    kit::Series series{.name = name, .style = style};
    for (const Row& row : rows) series.points.push_back({static_cast<double>(row.pes), of(row)});
    chart.series.push_back(std::move(series));
  };
  add("set-up", [](const Row& r) { return r.seconds.setup; });
  add("broad", [](const Row& r) { return r.seconds.broad; });
  add("narrow", [](const Row& r) { return r.seconds.narrow; });
  add("apply", [](const Row& r) { return r.seconds.apply; });
  add("together", distributed_seconds);
  add("together and gathered", gathered_seconds);
  const Row& first = rows.front();
  add(
      "together, ideal",
      [&](const Row& r) { return distributed_seconds(first) * first.pes / r.pes; },
      kit::Style::dashes);
  (void)kit::write_svg(prefix + ".svg", chart);
}

}  // namespace m2m_scaling
