#include "apps/task_bench/report.hpp"

#include "apps/kit/limits.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace task_bench {
namespace {

using kit::Json, kit::rounded;

std::string microseconds(double seconds) {
  return fmt::format("{:.4g}", 1e6 * seconds);
}
double grain_us(const Row& row) {
  return 1e6 * row.grain_seconds;
}

constexpr kit::Column<Row> of_a_grain[] = {
    {"type", "", nullptr, kit::of<&Row::type>},
    {"kernel", "", nullptr, kit::of<&Row::kernel>},
    {"width", "", nullptr, kit::of<&Row::width>},
    {"steps", "", nullptr, kit::of<&Row::steps>},
    {"pes", "", nullptr, kit::of<&Row::pes>},
    {"ranks", "", nullptr, kit::of<&Row::ranks>},
    {"iterations", "", nullptr, kit::of<&Row::iterations>},
    {"tasks", "", nullptr, kit::of<&Row::n_tasks>},
    {"dependences", "", nullptr, kit::of<&Row::n_dependences>},
    {"grain_us", "", nullptr, [](const Row& r) { return rounded(grain_us(r)); }},
    {"seconds", "", nullptr, [](const Row& r) { return rounded(r.seconds); }},
    {"efficiency", "", nullptr, [](const Row& r) { return rounded(r.efficiency); }}};
const kit::Rows<Row>& grains() {
  static const kit::Rows<Row> rows(of_a_grain);
  return rows;
}

using R = const Result&;
const Row& first(R result) {
  return result.rows.front();
}
/// A figure of METG as the table has it.
template <double Metg::*seconds>
Json shown(R result) {
  if (!result.metg) return "none";
  std::string text = result.metg->below ? "<" : "";
  return text.append(microseconds((*result.metg).*seconds));
}
template <double Metg::*seconds>
Json us(R result) {
  return result.metg ? rounded(1e6 * ((*result.metg).*seconds)) : Json();
}

constexpr kit::Column<Result> columns[] = {
    {"type", "type", "<22", [](R r) -> Json { return first(r).type; }},
    {"kernel", "kernel", "<14", [](R r) -> Json { return first(r).kernel; }},
    {"width", "width", "7", [](R r) -> Json { return first(r).width; }},
    {"steps", "steps", "7", [](R r) -> Json { return first(r).steps; }},
    {"pes", "PEs", "5", [](R r) -> Json { return first(r).pes; }},
    {"ranks", "ranks", "6", [](R r) -> Json { return first(r).ranks; }},
    {"", "METG us", "12", shown<&Metg::grain_seconds>},
    {"metg_us", "", nullptr, us<&Metg::grain_seconds>},
    {"", "wall us", "12", shown<&Metg::wall_seconds>},
    {"metg_wall_us", "", nullptr, us<&Metg::wall_seconds>},
    {"metg_is_upper_bound", "", nullptr, [](R r) -> Json { return r.metg && r.metg->below; }},
    {"", "grains", "7", [](R r) -> Json { return r.rows.size(); }},
    {"limits", "", nullptr, [](R r) -> Json { return kit::limits_json(r.limits); }},
    {"grains", "", nullptr, [](R r) { return grains().json(r.rows); }}};

}  // namespace

const kit::Rows<Result>& report() {
  static const kit::Rows<Result> rows(columns);
  return rows;
}

std::string limits_text(const Result& result) {
  return fmt::format("Limits of {}: {}\n", first(result).type, tess::describe(result.limits));
}

std::string run_text(const Result& result) {
  const Row& row = result.rows.front();
  std::uint64_t n_flops = 0, n_bytes = 0;
  for (const Graph& graph : result.graphs) {
    const Totals all = totals(graph);
    n_flops += flops(graph.kernel, all.n_tasks, all.n_iterations);
    n_bytes += bytes(graph.kernel, all.n_iterations);
  }
  const auto tasks = static_cast<double>(row.n_tasks);
  std::string text = fmt::format(
      "Total Tasks {}\nTotal Dependencies {}\nTotal FLOPs {}\nTotal Bytes {}\n"
      "Elapsed Time {:e} seconds\nFLOP/s {:e}\nB/s {:e}\n"
      "PEs {} on {} ranks\nTask Granularity {} us (elapsed x PEs / tasks), kernel {} us\n"
      "Efficiency {:.4f} (kernels / (elapsed x PEs)); every input was checked\n",
      row.n_tasks, row.n_dependences, n_flops, n_bytes, row.seconds,
      static_cast<double>(n_flops) / row.seconds, static_cast<double>(n_bytes) / row.seconds,
      row.pes, row.ranks, microseconds(row.seconds * row.pes / tasks),
      microseconds(row.grain_seconds), row.efficiency);
  for (const std::vector<tess::balance::Round>& rounds : result.rounds) {
    if (rounds.empty()) continue;
    std::size_t n_moved = 0;
    for (const tess::balance::Round& round : rounds) n_moved += round.n_moved;
    text += fmt::format("Balance Rounds {}, {} columns moved, max/average {:.3f} -> {:.3f}\n",
                        rounds.size(), n_moved, rounds.front().before, rounds.back().before);
  }
  return text + limits_text(result);
}

std::string explain(const Settings& settings) {
  std::string text;
  for (const std::vector<Graph>& graphs : cases(settings)) {
    for (const Graph& g : graphs) {
      const Totals all = totals(g);
      text += fmt::format("{}: {} tasks, {} dependences of {} bytes, {} dependence sets; ",
                          name_of(g.type), all.n_tasks, all.n_dependences,
                          (g.output_bytes + 15) / 16 * 16, n_sets(g));
      text += g.type == Type::dom || g.type == Type::tree
                  ? "points come and go\n"
                  : "all points at every step: none is looked up\n";
    }
  }
  text += settings.balance
              ? fmt::format("columns are measured and balanced by {}\n", settings.balance->strategy)
              : "no balancer: nothing is measured, no barrier\n";
  return text;
}

std::string csv_of(const std::vector<Result>& results) {
  std::vector<Row> all;
  for (const Result& result : results)
    all.insert(all.end(), result.rows.begin(), result.rows.end());
  return grains().csv(all);
}

kit::Chart chart_of(const std::vector<Result>& results) {
  const Row& one = first(results.front());
  kit::Chart chart{.title = fmt::format("Task Bench, {} PEs on {} ranks", one.pes, one.ranks),
                   .x_label = "kernel of one task, us",
                   .y_label = "efficiency",
                   .x_log = true};
  double least = 1e300, most = 0;
  for (const Result& result : results)
    for (const Row& row : result.rows) {
      kit::add_point(chart, row.type, grain_us(row), row.efficiency);
      least = std::min(least, grain_us(row));
      most = std::max(most, grain_us(row));
    }
  chart.series.push_back(
      {.name = "one half", .points = {{least, 0.5}, {most, 0.5}}, .style = kit::Style::dashes});
  return chart;
}

}  // namespace task_bench
