#include "apps/leanmd/report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace leanmd {
namespace {

using R = const Row&;
using kit::Json;

std::string cells(const Options& options) {
  return fmt::format("{}", fmt::join(options.problem.box.n_cells, " x "));
}

std::size_t n_computes(const Problem& problem) {
  // The neighbourhoods of all cells are alike; a pair of two cells is in two of them.
  const auto& n = problem.box.n_cells;
  const auto n_cells = static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
                       static_cast<std::size_t>(n[2]);
  const auto n_partners = problem.box.cells_within(problem.cutoff + problem.skin, {}).size();
  return n_cells * (n_partners + 1) / 2;
}

std::string balancing(const tess::BalanceOptions& balance, std::int32_t every) {
  const std::string by = "computes are measured, and balanced by " + balance.strategy;
  switch (balance.when) {
    case tess::BalanceWhen::at_sync:
      return fmt::format("{} every {} steps\n", by, every);
    case tess::BalanceWhen::automatic:
      return fmt::format("{}; every {} steps a barrier, and a round if it pays off\n", by, every);
    case tess::BalanceWhen::periodic:
      return fmt::format("{} every {} ms, beside the steps\n", by,
                         std::chrono::duration<double, std::milli>(balance.period).count());
  }
  return "";
}

/// A run that ended early has no drift.
Json drift(R row) {
  return row.outcome.error.empty() ? Json(row.outcome.drift()) : Json();
}
Json dt(R row) {
  return row.options.problem.dt;
}
Json seconds(R row) {
  return row.outcome.seconds;
}
Json balance_rounds(R row) {
  Json rounds = Json::array();
  for (const tess::balance::Round& round : row.outcome.rounds)
    rounds.push_back({{"moved", round.n_moved},
                      {"max_over_average", round.before},
                      {"predicted", round.predicted},
                      {"phase_seconds", round.phase_seconds},
                      {"round_seconds", round.round_seconds}});
  return rounds;
}
/// Null where forces were not compared.
Json wrong_forces(R row) {
  return row.outcome.wrong_forces >= 0 ? Json(row.outcome.wrong_forces) : Json();
}

constexpr kit::Column<Row> columns[] = {
    {"atoms", "", nullptr, [](R r) -> Json { return r.outcome.n_atoms; }},
    {"cells", "", nullptr, [](R r) -> Json { return r.options.problem.box.n_cells; }},
    {"dt", "dt", "10.4g", dt},
    {"steps", "steps", "7", [](R r) -> Json { return r.options.n_steps; }},
    {"cutoff", "", nullptr, [](R r) -> Json { return r.options.problem.cutoff; }},
    {"energy", "", nullptr, [](R r) -> Json { return r.outcome.energy(); }},
    {"energy_drift", "energy drift", "13.3e", drift},
    {"order", "order", "7.2f", [](R r) -> Json { return r.order; }},
    {"seconds", "s", "11.4f", seconds},
    {"wrong_forces", "", nullptr, wrong_forces},
    {"balance_rounds", "", nullptr, balance_rounds},
    {"error", "", "<", [](R r) -> Json { return r.outcome.error; }},
    {"result_hash", "", nullptr, [](R r) -> Json { return kit::hex(r.outcome.hash); }}};

}  // namespace

const kit::Rows<Row>& report() {
  static const kit::Rows<Row> rows(columns);
  return rows;
}

std::optional<double> fitted_order(std::span<const Row> rows) {
  return kit::fitted_order(rows, &dt, &drift);
}

kit::Chart chart_of(std::span<const Row> rows) {
  kit::Chart chart{.title = "velocity Verlet: error against run time",
                   .x_label = "seconds",
                   .y_label = "energy drift per atom",
                   .x_log = true,
                   .y_log = true};
  for (const Row& row : rows)
    kit::add_point(chart, "dt from left to right: shorter", seconds(row), drift(row));
  if (chart.series.empty()) return chart;
  // Twice the steps, a quarter of the error.
  const kit::Point first = chart.series[0].points.front(), last = chart.series[0].points.back();
  chart.series.push_back({.name = "order 2",
                          .points = {first, {last.x, first.y * std::pow(first.x / last.x, 2)}},
                          .style = kit::Style::dashes});
  return chart;
}

std::string explain(const Options& options, std::int64_t n_atoms) {
  const Problem& p = options.problem;
  return fmt::format(
      "{} atoms in a periodic cube of edge {:.4g}, {} cells, {} computes; a cell is in {} of them\n"
      "{} steps of {}; all pairs closer than {}; atoms change cells every {} steps\n{}",
      n_atoms, p.box.edge, cells(options), n_computes(p),
      p.box.cells_within(p.cutoff + p.skin, {}).size(), options.n_steps, p.dt, p.cutoff,
      p.exchange_every,
      options.balance ? balancing(*options.balance, p.every)
                      : std::string("no balancer: nothing is measured, no barrier\n"));
}

std::string summary(const Row& row) {
  const Outcome& outcome = row.outcome;
  const auto per_atom = [&](const Vector& energies, std::size_t k) {
    return static_cast<double>(energies[k]) * energy_quantum / static_cast<double>(outcome.n_atoms);
  };
  std::string out = fmt::format("{:>8}{:>14}{:>14}{:>14}   energies per atom\n", "step", "kinetic",
                                "potential", "total");
  const std::size_t last = outcome.energies.size() - 1;  // of a run that ended early the last good
  for (std::size_t step = 0; step <= last; step += std::max<std::size_t>(1, last / 5)) {
    const Vector& one = outcome.energies[step];
    out += fmt::format("{:>8}{:>14.6f}{:>14.6f}{:>14.6f}\n", step, per_atom(one, 0),
                       per_atom(one, 1), per_atom(one, 2));
  }
  for (const tess::balance::Round& round : outcome.rounds)
    out +=
        fmt::format("balance round {}: {} of {} computes moved, max/average {:.3f} -> {:.3f}\n",
                    round.number, round.n_moved, round.n_elements, round.before, round.predicted);
  out += fmt::format(
      "{} atoms, {} cells, {} steps: {:.6f} s, {:.3f} ms a step; energy drift {:.3e}{}; hash "
      "{:016x}\n",
      outcome.n_atoms, cells(row.options), last, outcome.seconds,
      1e3 * outcome.seconds / static_cast<double>(std::max<std::size_t>(1, last)), outcome.drift(),
      outcome.wrong_forces == 0 ? "; forces as of all pairs" : "", outcome.hash);
  return out;
}

}  // namespace leanmd
