#include "apps/nqueens/report.hpp"

#include "runtime/runtime.hpp"

#include <fmt/format.h>

namespace nqueens {
namespace {

using R = const Row&;
using kit::Json;

const char* name_of(Form form) {
  return form == Form::group ? "group" : "chares";
}

/// The number of solutions; null where the first was looked for.
Json solutions(R row) {
  return row.problem.first ? Json() : Json(row.outcome.count.n_solutions);
}
/// The first solution, "" for none; null where all were counted.
Json first(R row) {
  if (!row.problem.first) return {};
  return row.outcome.found ? to_text(row.outcome.solution, row.problem.n) : "";
}

constexpr kit::Column<Row> columns[] = {
    {"n", "n", "3", [](R r) -> Json { return r.problem.n; }},
    {"grain", "grain", "6", [](R r) -> Json { return r.problem.grain; }},
    {"form", "form", "7", [](R r) -> Json { return name_of(r.problem.form); }},
    {"priority", "priority", "9",
     [](R r) -> Json { return r.problem.prioritised ? "path" : "none"; }},
    {"solutions", "solutions", "12", solutions},
    {"boards", "boards", "12", [](R r) -> Json { return r.outcome.count.n_boards; }},
    {"tasks", "tasks", "9", [](R r) -> Json { return r.outcome.n_tasks; }},
    {"dropped", "dropped", "9", [](R r) -> Json { return r.outcome.n_dropped; }},
    {"seconds", "seconds", "10.6f", [](R r) -> Json { return r.outcome.seconds; }},
    {"efficiency", "efficiency", "10.3f",
     [](R r) { return r.efficiency > 0 ? Json(r.efficiency) : Json(); }},
    {"first", "", nullptr, first},
    {"result_hash", "", nullptr, [](R r) -> Json { return kit::hex(r.outcome.hash); }},
    {"", "", "<", [](R r) -> Json {
       if (!r.problem.first) return "";
       return r.outcome.found ? to_text(r.outcome.solution, r.problem.n) : "no solution";
     }}};

}  // namespace

const kit::Rows<Row>& report() {
  static const kit::Rows<Row> rows(columns);
  return rows;
}

std::string fault(const Row& row, std::uint64_t expected) {
  const auto& [problem, outcome, efficiency] = row;
  if (!problem.first) {
    if (outcome.count.n_solutions == expected) return "";
    return fmt::format("{} queens have {} solutions, found {}", problem.n, expected,
                       outcome.count.n_solutions);
  }
  if (outcome.found != (expected > 0))
    return fmt::format("{} queens have {} solutions, but {} was found", problem.n, expected,
                       outcome.found ? "one" : "none");
  std::uint64_t n_boards = 0;
  const auto serial = first_below(Board(), problem.n, n_boards);
  if (!outcome.found || (is_solution(outcome.solution, problem.n) && serial == outcome.solution))
    return "";
  return fmt::format("{} is not the first solution", to_text(outcome.solution, problem.n));
}

kit::Chart chart_of(const std::vector<Row>& rows) {
  kit::Chart chart{.title = fmt::format("{} queens, {} PEs", rows.front().problem.n, tess::n_pes()),
                   .x_label = "tasks (messages)",
                   .y_label = "efficiency",
                   .x_log = true};
  for (const Row& row : rows)
    kit::add_point(chart, name_of(row.problem.form), row.outcome.n_tasks, row.efficiency);
  return chart;
}

}  // namespace nqueens
