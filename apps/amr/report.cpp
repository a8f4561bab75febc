#include "apps/amr/report.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace amr {
namespace {

/// "2-4": the levels that the tree may have.
std::string levels(const Problem& problem) {
  return problem.least_level == problem.most_level
             ? std::to_string(problem.most_level)
             : fmt::format("{}-{}", problem.least_level, problem.most_level);
}

}  // namespace

std::string head() {
  return fmt::format(
      "{:>5} {:>6} {:>5} {:>6} {:>6} {:>8} {:>9} {:>9} {:>10} {:>10} {:>10} {:>12} {:>10}\n",
      "order", "levels", "cfl", "steps", "blocks", "created", "destroyed", "seconds", "L1", "L2",
      "max", "mass change", "ns per cell");
}

std::string line(const Row& row) {
  const Problem& problem = row.settings.problem;
  const Outcome& o = row.outcome;
  return fmt::format(
      "{:>5} {:>6} {:>5.3g} {:>6} {:>6} {:>8} {:>9} {:>9.4f} {:>10.3e} {:>10.3e} {:>10.3e} {:>12} "
      "{:>10.1f}\n",
      problem.order, levels(problem), problem.cfl, problem.n_steps, o.most_blocks, o.n_created,
      o.n_destroyed, o.seconds, o.l1(), o.l2(), o.end.norms.linf,
      o.end.norms.mass - o.mass_at_start, 1e9 * o.seconds / static_cast<double>(o.cell_steps));
}

std::string fault(const Outcome& outcome) {
  const std::int64_t change = outcome.end.norms.mass - outcome.mass_at_start;
  if (change == 0) return "";
  return fmt::format("the mass changed by {} of {} quanta", change, outcome.mass_at_start);
}

plot::Json json_of(const std::vector<Row>& rows) {
  plot::Json all = plot::Json::array();
  for (const auto& [settings, o] : rows) {
    const Problem& p = settings.problem;
    all.push_back({{"order", p.order},
                   {"least_level", p.least_level},
                   {"max_level", p.most_level},
                   {"cells", p.n_cells},
                   {"cfl", p.cfl},
                   {"time", p.end},
                   {"steps", p.n_steps},
                   {"blocks", o.end.n_blocks},
                   {"most_blocks", o.most_blocks},
                   {"created", o.n_created},
                   {"destroyed", o.n_destroyed},
                   {"moved", o.n_moved},
                   {"of_level", o.end.of_level},
                   {"seconds", o.seconds},
                   {"cell_steps", o.cell_steps},
                   {"l1", o.l1()},
                   {"l2", o.l2()},
                   {"linf", o.end.norms.linf},
                   {"largest", o.end.norms.largest},
                   {"least", o.end.norms.least},
                   {"mass_quanta", o.end.norms.mass},
                   {"mass_change_quanta", o.end.norms.mass - o.mass_at_start},
                   {"result_hash", fmt::format("{:016x}", o.end.norms.hash)}});
  }
  return all;
}

plot::Chart chart_of(const std::vector<Row>& rows) {
  plot::Chart chart{.title = "error against run time, from the coarsest to the finest tree",
                    .x_label = "seconds",
                    .y_label = "L1 error",
                    .x_log = true,
                    .y_log = true};
  const std::int32_t coarsest = rows.front().settings.problem.least_level;
  for (const Row& row : rows) {
    const Problem& p = row.settings.problem;
    const std::string name =
        fmt::format("order {}{}", p.order, p.least_level > coarsest ? ", uniform" : "");
    const auto same = std::ranges::find(chart.series, name, &plot::Series::name);
    plot::Series& series =
        same != chart.series.end() ? *same : chart.series.emplace_back(plot::Series{.name = name});
    series.points.push_back({row.outcome.seconds, row.outcome.l1()});
  }
  return chart;
}

}  // namespace amr
