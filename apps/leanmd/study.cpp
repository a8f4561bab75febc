#include "apps/leanmd/study.hpp"

#include <cmath>

namespace leanmd {
namespace {

using R = const StudyRow&;
using kit::Json;

Json drift(R row) {
  return row.error.empty() ? Json(row.drift) : Json();
}

constexpr kit::Column<StudyRow> columns[] = {{"dt", "dt", "10.4g", kit::of<&StudyRow::dt>},
                                             {"steps", "steps", "7", kit::of<&StudyRow::n_steps>},
                                             {"energy_drift", "energy drift", "13.3e", drift},
                                             {"order", "order", "7.2f", kit::of<&StudyRow::order>},
                                             {"seconds", "s", "11.4f", kit::of<&StudyRow::seconds>},
                                             {"error", "", "<", kit::of<&StudyRow::error>}};

}  // namespace

tess::Task study(Options options, InitialState state, std::vector<StudyRow>& rows) {
  const double dt = options.problem.dt;
  const double time = dt * options.n_steps;
  for (const double factor : {2.0, 1.0, 0.5, 0.25, 0.125}) {
    options.problem.dt = dt * factor;
    options.n_steps = static_cast<std::int32_t>(std::lround(time / options.problem.dt));
    const Motion motion(options.problem.box.edge, options.problem.dt);
    Outcome outcome;
    co_await simulate(options, initial_atoms(state, motion), outcome);
    StudyRow row{.dt = options.problem.dt,
                 .n_steps = options.n_steps,
                 .drift = outcome.drift(),
                 .seconds = outcome.seconds,
                 .error = outcome.error,
                 .is_wrong = outcome.is_wrong};
    if (!rows.empty() && rows.back().error.empty())
      row.order = kit::order_between({rows.back().dt, rows.back().drift}, {row.dt, row.drift});
    rows.push_back(row);
  }
}

const kit::Rows<StudyRow>& study_rows() {
  static const kit::Rows<StudyRow> rows(columns);
  return rows;
}

std::optional<double> fitted_order(const std::vector<StudyRow>& rows) {
  return kit::fitted_order<StudyRow>(rows, kit::of<&StudyRow::dt>, drift);
}

kit::Chart study_chart(const std::vector<StudyRow>& rows) {
  kit::Chart chart{.title = "velocity Verlet: error against run time",
                   .x_label = "seconds",
                   .y_label = "energy drift per atom",
                   .x_log = true,
                   .y_log = true};
  for (const StudyRow& row : rows)
    kit::add_point(chart, "dt from left to right: shorter", row.seconds, drift(row));
  if (chart.series.empty()) return chart;
  // Twice the steps, a quarter of the error.
  const kit::Point first = chart.series.front().points.front();
  const kit::Point last = chart.series.front().points.back();
  chart.series.push_back({.name = "order 2",
                          .points = {first, {last.x, first.y * std::pow(first.x / last.x, 2)}},
                          .style = kit::Style::dashes});
  return chart;
}

}  // namespace leanmd
