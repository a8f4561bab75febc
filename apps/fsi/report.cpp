#include "apps/fsi/report.hpp"

#include <fmt/format.h>

namespace fsi {
namespace {

using kit::Json;

constexpr double kept = 1e-12;  // of sums of forces, moments and work

double iterations_of(const Outcome& outcome, std::int32_t n_steps) {
  return static_cast<double>(outcome.n_iterations) / n_steps;
}

constexpr kit::Column<Row> columns[] = {
    {"panel", "panel", "6", [](const Row& r) -> Json { return r.problem.n_panel; }},
    {"flow", "flow", "6", [](const Row& r) -> Json { return r.problem.n_flow; }},
    {"steps", "steps", "6", [](const Row& r) -> Json { return r.problem.n_steps; }},
    {"substeps", "substeps", "9", [](const Row& r) -> Json { return r.problem.n_substeps; }},
    {"added_mass_ratio", "m_a / m", "8.3g",
     [](const Row& r) -> Json { return r.problem.added_mass() / r.problem.mass; }},
    {"iterations_per_step", "iterations", "11.1f",
     [](const Row& r) -> Json { return iterations_of(r.outcome, r.problem.n_steps); }},
    {"seconds", "seconds", "9.4f", [](const Row& r) -> Json { return r.outcome.seconds; }},
    {"error", "error", "9.2e", [](const Row& r) -> Json { return r.outcome.error; }},
    {"energy_drift", "energy", "9.2e", [](const Row& r) -> Json { return r.outcome.energy_drift; }},
    {"force_gap", "forces", "9.2e", [](const Row& r) -> Json { return r.outcome.force_gap; }},
    {"moment_gap", "moments", "9.2e", [](const Row& r) -> Json { return r.outcome.moment_gap; }},
    {"work_gap", "work", "9.2e", [](const Row& r) -> Json { return r.outcome.work_gap; }},
    {"moved", "moved", "6", [](const Row& r) -> Json { return r.outcome.n_moved; }},
    {"result_hash", "", nullptr, [](const Row& r) -> Json { return kit::hex(r.outcome.hash); }}};

tess::Task run(const Problem& problem, Outcome& outcome) {
  Settings settings{.problem = problem};
  co_await simulate(settings, outcome);
}

}  // namespace

const kit::Rows<Row>& report() {
  static const kit::Rows<Row> rows(columns);
  return rows;
}

kit::Chart chart_of(const std::vector<Row>& rows) {
  kit::Chart chart;
  chart.title = "panel in a channel: error against run time";
  chart.x_label = "seconds";
  chart.y_label = "error, of the amplitude";
  chart.x_log = chart.y_log = true;
  for (const Row& row : rows)
    kit::add_point(chart, row.problem.adapts ? "Aitken's factors" : "one factor",
                   row.outcome.seconds, row.outcome.error);
  return chart;
}

std::string explanation(const Settings& settings) {
  const Problem& p = settings.problem;
  return fmt::format(
      "panel: {0} x {0} squares of 2 triangles, {1} pieces; {2} small steps in a step of {3:.3g}\n"
      "fluid: {4} x {4} squares, {1} pieces; its pressure is that of the added mass {5:.3g}\n"
      "displacements go by projection, forces by its transposed rows: one search for both\n"
      "corrections: {6}\n"
      "left out: {7}, search in the steps (the meshes stay at rest), flow along the panel\n",
      p.n_panel, p.n_pieces, p.n_substeps, p.dt(), p.n_flow, p.added_mass(),
      p.adapts ? "factors after Aitken" : fmt::format("the factor {}", p.relaxation),
      settings.balance ? "nothing of balancing" : "load measurement and balancing");
}

std::string fault(const Outcome& outcome) {
  if (outcome.diverged) return "panel and fluid did not agree in a step";
  if (!(outcome.force_gap < kept && outcome.moment_gap < kept && outcome.work_gap < kept))
    return fmt::format(
        "between the meshes {:.2e} of the force, {:.2e} of moments and {:.2e} of work are lost",
        outcome.force_gap, outcome.moment_gap, outcome.work_gap);
  return "";
}

tess::Task run_stability(std::int32_t n_pieces, kit::Cases<>& cases) {
  Problem usual;
  usual.n_panel = 8;
  usual.n_pieces = n_pieces;
  usual.n_steps = 25;
  usual.per_period = 20;
  for (const double ratio : {0.0, 0.1, 1.0, 10.0, 100.0, 1000.0})
    for (const bool adapts : {true, false}) {
      Problem p = usual;
      p.density = 1;
      p.density = ratio * p.mass / p.added_mass();
      p.adapts = adapts;
      // A displacement of 1 gives 2 m_a/Δt² of force, and this Δt²/2 m of displacement: corrections
      // with a factor f grow where f (1 + m_a / m) is above 2.
      const bool converges = adapts || p.relaxation * (1 + ratio) < 2;
      Outcome outcome;
      p.complete(tess::n_pes());
      co_await run(p, outcome);
      const std::string why = outcome.diverged ? "" : fault(outcome);
      const double drift = outcome.energy_drift;
      const bool ok =
          converges ? !outcome.diverged && why.empty() && outcome.error < 0.15 : outcome.diverged;
      cases.add({.name = adapts ? "Aitken's factors" : "one factor, 0.5",
                 .parameter = "m_a / m",
                 .value = ratio,
                 .met = outcome.diverged ? std::optional<double>() : outcome.error,
                 .tolerance = converges ? std::optional(0.15) : std::nullopt,
                 .ok = ok,
                 .note = outcome.diverged
                             ? "no agreement, and it says so"
                             : fmt::format("{:.1f} corrections a step, energy drifts by {:.1e}{}",
                                           iterations_of(outcome, p.n_steps), drift,
                                           why.empty() ? "" : "; " + why)});
    }
}

}  // namespace fsi
