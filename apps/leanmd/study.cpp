#include "apps/leanmd/study.hpp"

#include "apps/kit/chart.hpp"
#include "apps/kit/fit.hpp"
#include "apps/kit/json.hpp"
#include "runtime/here.hpp"

#include <cmath>
#include <fmt/format.h>

namespace leanmd {

tess::Task study(Options options, InitialState state, std::vector<StudyRow>& rows) {
  const double dt = options.problem.dt;
  const double time = dt * options.n_steps;
  for (const double factor : {2.0, 1.0, 0.5, 0.25, 0.125}) {
    options.problem.dt = dt * factor;
    options.n_steps = static_cast<std::int32_t>(std::lround(time / options.problem.dt));
    const Motion motion(options.problem.box.edge, options.problem.dt);
    Outcome outcome;
    co_await simulate(options, initial_atoms(state, motion), outcome);
    StudyRow row{options.problem.dt, options.n_steps, outcome.drift(), outcome.seconds, 0,
                 outcome.error,      outcome.is_wrong};
    if (!rows.empty() && rows.back().error.empty() && row.drift > 0 && rows.back().drift > 0)
      row.order = std::log(rows.back().drift / row.drift) / std::log(rows.back().dt / row.dt);
    rows.push_back(row);
  }
}

std::optional<double> fitted_order(const std::vector<StudyRow>& rows) {
  std::vector<kit::Point> drifts;
  for (const StudyRow& row : rows)
    if (row.error.empty()) drifts.push_back({row.dt, row.drift});
  return kit::fitted_power(drifts);
}

std::string study_table(const std::vector<StudyRow>& rows) {
  std::string out =
      fmt::format("{:>10}{:>8}{:>14}{:>8}{:>12}\n", "dt", "steps", "energy drift", "order", "s");
  for (const StudyRow& row : rows) {
    if (!row.error.empty()) {
      out += fmt::format("{:>10.4g}{:>8}  {}\n", row.dt, row.n_steps, row.error);
      continue;
    }
    out += fmt::format("{:>10.4g}{:>8}{:>14.3e}{:>8}{:>12.4f}\n", row.dt, row.n_steps, row.drift,
                       row.order == 0 ? "-" : fmt::format("{:.2f}", row.order), row.seconds);
  }
  const std::optional<double> order = fitted_order(rows);
  return out + fmt::format("fitted order {}; drift: greatest change of the total energy per atom\n",
                           order ? fmt::format("{:.2f}", *order) : "-");
}

std::string study_json(const std::vector<StudyRow>& rows) {
  kit::Json list = kit::Json::array();
  for (const StudyRow& row : rows) {
    kit::Json one{{"dt", row.dt},
                  {"steps", row.n_steps},
                  {"energy_drift", row.drift},
                  {"seconds", row.seconds}};
    if (!row.error.empty()) one["error"] = row.error;
    list.push_back(std::move(one));
  }
  kit::Json out{{"machine", tess::machine().describe()},
                {"fitted_order", nullptr},
                {"rows", std::move(list)}};
  if (const std::optional<double> order = fitted_order(rows)) out["fitted_order"] = *order;
  return kit::json_text(out);
}

void draw_study(const std::string& svg, const std::vector<StudyRow>& rows) {
  kit::Chart chart{.title = "velocity Verlet: error against run time",
                   .x_label = "seconds",
                   .y_label = "energy drift per atom",
                   .x_log = true,
                   .y_log = true};
  kit::Series drift{.name = "dt from left to right: shorter"};
  for (const StudyRow& row : rows)
    if (row.error.empty()) drift.points.push_back({row.seconds, row.drift});
  chart.series = {std::move(drift)};
  // Twice the steps, a quarter of the error.
  if (const std::vector<kit::Point>& points = chart.series.front().points; !points.empty()) {
    const kit::Point first = points.front(), last = points.back();
    chart.series.push_back({.name = "order 2",
                            .points = {first, {last.x, first.y * std::pow(first.x / last.x, 2)}},
                            .style = kit::Style::dashes});
  }
  (void)kit::write_svg(svg, chart);
}

}  // namespace leanmd
