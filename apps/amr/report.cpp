#include "apps/amr/report.hpp"

#include <fmt/format.h>

namespace amr {
namespace {

using R = const Row&;
using kit::Json;

/// "2-4": the levels that the tree may have.
Json levels(R row) {
  const Problem& p = row.settings.problem;
  return p.least_level == p.most_level ? std::to_string(p.most_level)
                                       : fmt::format("{}-{}", p.least_level, p.most_level);
}
Json l1(R row) {
  return row.outcome.l1();
}
Json seconds(R row) {
  return row.outcome.seconds;
}
std::int64_t mass_change(const Outcome& outcome) {
  return outcome.end.norms.mass - outcome.mass_at_start;
}

constexpr kit::Column<Row> columns[] = {
    {"order", "order", "5", [](R r) -> Json { return r.settings.problem.order; }},
    {"", "levels", "6", levels},
    {"least_level", "", nullptr, [](R r) -> Json { return r.settings.problem.least_level; }},
    {"max_level", "", nullptr, [](R r) -> Json { return r.settings.problem.most_level; }},
    {"cells", "", nullptr, [](R r) -> Json { return r.settings.problem.n_cells; }},
    {"cfl", "cfl", "5.3g", [](R r) -> Json { return r.settings.problem.cfl; }},
    {"time", "", nullptr, [](R r) -> Json { return r.settings.problem.end; }},
    {"steps", "steps", "6", [](R r) -> Json { return r.settings.problem.n_steps; }},
    {"blocks", "", nullptr, [](R r) -> Json { return r.outcome.end.n_blocks; }},
    {"most_blocks", "blocks", "6", [](R r) -> Json { return r.outcome.most_blocks; }},
    {"created", "created", "8", [](R r) -> Json { return r.outcome.n_created; }},
    {"destroyed", "destroyed", "9", [](R r) -> Json { return r.outcome.n_destroyed; }},
    {"moved", "", nullptr, [](R r) -> Json { return r.outcome.n_moved; }},
    {"of_level", "", nullptr, [](R r) -> Json { return r.outcome.end.of_level; }},
    {"seconds", "seconds", "9.4f", seconds},
    {"cell_steps", "", nullptr, [](R r) -> Json { return r.outcome.cell_steps; }},
    {"l1", "L1", "10.3e", l1},
    {"l2", "L2", "10.3e", [](R r) -> Json { return r.outcome.l2(); }},
    {"linf", "max", "10.3e", [](R r) -> Json { return r.outcome.end.norms.linf; }},
    {"largest", "", nullptr, [](R r) -> Json { return r.outcome.end.norms.largest; }},
    {"least", "", nullptr, [](R r) -> Json { return r.outcome.end.norms.least; }},
    {"mass_quanta", "", nullptr, [](R r) -> Json { return r.outcome.end.norms.mass; }},
    {"mass_change_quanta", "mass change", "12", [](R r) -> Json { return mass_change(r.outcome); }},
    {"", "ns per cell", "10.1f",
     [](R r)
         -> Json { return 1e9 * r.outcome.seconds / static_cast<double>(r.outcome.cell_steps); }},
    {"result_hash", "", nullptr, [](R r) -> Json { return kit::hex(r.outcome.end.norms.hash); }}};

}  // namespace

const kit::Rows<Row>& report() {
  static const kit::Rows<Row> rows(columns);
  return rows;
}

std::string fault(const Outcome& outcome) {
  if (mass_change(outcome) == 0) return "";
  return fmt::format("the mass changed by {} of {} quanta", mass_change(outcome),
                     outcome.mass_at_start);
}

kit::Chart chart_of(const std::vector<Row>& rows) {
  kit::Chart chart{.title = "error against run time, from the coarsest to the finest tree",
                   .x_label = "seconds",
                   .y_label = "L1 error",
                   .x_log = true,
                   .y_log = true};
  for (const Row& row : rows) {
    const Problem& p = row.settings.problem;
    const bool uniform = p.least_level > rows.front().settings.problem.least_level;
    kit::add_point(chart, fmt::format("order {}{}", p.order, uniform ? ", uniform" : ""),
                   seconds(row), l1(row));
  }
  return chart;
}

}  // namespace amr
