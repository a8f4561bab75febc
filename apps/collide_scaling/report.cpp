#include "apps/collide_scaling/report.hpp"

#include "apps/kit/chart.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace collide_scaling {
namespace {

double total_seconds(const Row& row) {
  return row.step.seconds + row.balance_seconds;
}

/// Weak: the time of the first row over that of this one. Strong: per PE.
double efficiency(const Row& row, const Row& first) {
  const double speed_up = total_seconds(first) / total_seconds(row);
  return row.given.is_strong ? speed_up * first.given.n_pes / row.given.n_pes : speed_up;
}

}  // namespace

std::string head(bool is_strong) {
  return is_strong
             ? "| PEs | balancer | ms per step | of which balancing | moved voxels | speed-up |\n"
               "|---|---|---|---|---|---|\n"
             : "| PEs | triangles | there | ms per step | gridding and exchange | search | hits "
               "and end | efficiency |\n|---|---|---|---|---|---|---|---|\n";
}

std::string line(const Row& row, const Row& first) {
  const StepTimes& step = row.step;
  if (row.given.is_strong)
    return fmt::format("| {} | {} | {:.2f} | {:.2f} | {} | {:.1f} |\n", row.given.n_pes,
                       row.given.balance, 1e3 * total_seconds(row), 1e3 * row.balance_seconds,
                       row.n_moves, total_seconds(first) / total_seconds(row));
  const std::string there =
      row.given.thinned == 1 ? "all" : fmt::format("1 in {}", row.given.thinned);
  return fmt::format(
      "| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.1f} % |\n", row.given.n_pes,
      row.given.n_triangles * static_cast<std::uint64_t>(row.given.n_pes), there,
      1e3 * step.seconds, 1e3 * step.first_hits, 1e3 * (step.last_hits - step.first_hits),
      1e3 * (step.seconds - step.last_hits), 100 * efficiency(row, first));
}

std::string conclusion(const std::vector<Row>& rows, bool is_checked) {
  const Row& last = rows.back();
  const char* const how = last.given.work == Work::measured
                              ? "simulated: the clock of each PE counts its processor time"
                          : is_checked ? "predicted: simulated PEs pay the costs above"
                                       : "predicted, and doubtful: see the measurements above";
  return fmt::format("The efficiency on {} PEs is {:.1f} %, {}.", last.given.n_pes,
                     100 * efficiency(last, rows.front()), how);
}

void draw(const std::string& prefix, const std::vector<Row>& rows) {
  const bool is_strong = rows.front().given.is_strong;
  kit::Chart chart{
      .title = is_strong ? "a crowd on more and more PEs" : "as many triangles on each PE",
      .x_label = "PEs",
      .y_label = is_strong ? "ms per step" : "efficiency, %",
      .x_log = true,
      .y_log = is_strong};
  for (const Row& row : rows) {
    const std::string& name = row.given.balance;
    auto series = std::ranges::find(chart.series, name, &kit::Series::name);
    if (series == chart.series.end()) {
      chart.series.push_back({.name = name});
      series = chart.series.end() - 1;
    }
    series->points.push_back(
        {static_cast<double>(row.given.n_pes),
         is_strong ? 1e3 * total_seconds(row) : 100 * efficiency(row, rows.front())});
  }
  if (!is_strong) {
    const std::string what = rows.front().given.work == Work::measured
                                 ? "measured work and messages"
                                 : "modelled work and messages";
    const bool is_one = chart.series.size() == 1;
    for (kit::Series& series : chart.series)
      series.name = is_one ? what : what + ", " + series.name;
    chart.series.push_back({.name = "Lawlor and Kalé 2002, 1500 PEs",
                            .points = {{1500, 60}},
                            .style = kit::Style::points});
  }
  (void)kit::write_svg(prefix + ".svg", chart);
}

}  // namespace collide_scaling
