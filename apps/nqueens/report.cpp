#include "apps/nqueens/report.hpp"

#include "runtime/runtime.hpp"

#include <fmt/format.h>

namespace nqueens {
namespace {

const char* name_of(Form form) {
  return form == Form::group ? "group" : "chares";
}

}  // namespace

std::string head() {
  return fmt::format("{:>3} {:>6} {:>7} {:>9} {:>12} {:>12} {:>9} {:>9} {:>10} {:>10}\n", "n",
                     "grain", "form", "priority", "solutions", "boards", "tasks", "dropped",
                     "seconds", "efficiency");
}

std::string line(const Row& row) {
  const auto& [problem, outcome, efficiency] = row;
  std::string text =
      fmt::format("{:>3} {:>6} {:>7} {:>9} {:>12} {:>12} {:>9} {:>9} {:>10.6f} {:>10}\n", problem.n,
                  problem.grain, name_of(problem.form), problem.prioritised ? "path" : "none",
                  problem.first ? "first" : std::to_string(outcome.count.n_solutions),
                  outcome.count.n_boards, outcome.n_tasks, outcome.n_dropped, outcome.seconds,
                  efficiency > 0 ? fmt::format("{:.3f}", efficiency) : "");
  if (problem.first)
    text += "    " + (outcome.found ? to_text(outcome.solution, problem.n) : "no solution") + "\n";
  return text;
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

plot::Json json_of(const std::vector<Row>& rows) {
  plot::Json all = plot::Json::array();
  for (const auto& [problem, outcome, efficiency] : rows) {
    plot::Json one = {{"n", problem.n},
                      {"grain", problem.grain},
                      {"form", name_of(problem.form)},
                      {"priority", problem.prioritised ? "path" : "none"},
                      {"boards", outcome.count.n_boards},
                      {"tasks", outcome.n_tasks},
                      {"dropped", outcome.n_dropped},
                      {"seconds", outcome.seconds},
                      {"result_hash", fmt::format("{:016x}", outcome.hash)}};
    if (problem.first)
      one["first"] = outcome.found ? to_text(outcome.solution, problem.n) : "";
    else
      one["solutions"] = outcome.count.n_solutions;
    if (efficiency > 0) one["efficiency"] = efficiency;
    all.push_back(std::move(one));
  }
  return all;
}

plot::Chart chart_of(const std::vector<Row>& rows) {
  plot::Chart chart{
      .title = fmt::format("{} queens, {} PEs", rows.front().problem.n, tess::n_pes()),
      .x_label = "tasks (messages)",
      .y_label = "efficiency",
      .x_log = true};
  for (const Row& row : rows) {
    if (chart.series.empty() || chart.series.back().name != name_of(row.problem.form))
      chart.series.push_back({.name = name_of(row.problem.form)});
    chart.series.back().points.push_back(
        {static_cast<double>(row.outcome.n_tasks), row.efficiency});
  }
  return chart;
}

}  // namespace nqueens
