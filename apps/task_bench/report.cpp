#include "apps/task_bench/report.hpp"

#include "apps/kit/chart.hpp"
#include "apps/kit/json.hpp"
#include "apps/kit/write_file.hpp"

#include <fmt/format.h>

namespace task_bench {
namespace {

constexpr const char* metg_line = "{:<22} {:<14} {:>7} {:>7} {:>5} {:>6} {:>12} {:>12} {:>7}\n";

/// Rounds to six digits: more are noise and make the file harder to read.
double rounded(double value) {
  return std::stod(fmt::format("{:.6g}", value));
}

std::string microseconds(double seconds) {
  return fmt::format("{:.4g}", 1e6 * seconds);
}

void print_run(const Result& result) {
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
  tess::print_text(text);
}

}  // namespace

void print_head(const Settings& settings, const tess::Machine& machine) {
  tess::print_text(machine.describe() + "\n");
  if (!settings.metg) return;
  tess::print_text(fmt::format(fmt::runtime(metg_line), "type", "kernel", "width", "steps", "PEs",
                               "ranks", "METG us", "wall us", "grains"));
}

void print_result(const Settings& settings, const Result& result) {
  if (!settings.metg) {
    print_run(result);
    return;
  }
  const Row& row = result.rows.front();
  const auto& metg = result.metg;
  const char* below = metg && metg->below ? "<" : "";
  tess::print_text(
      fmt::format(fmt::runtime(metg_line), row.type, row.kernel, row.width, row.steps, row.pes,
                  row.ranks, metg ? below + microseconds(metg->grain_seconds) : "none",
                  metg ? below + microseconds(metg->wall_seconds) : "none", result.rows.size()));
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

void write_json(const std::string& path, const std::vector<Result>& results,
                const std::string& machine) {
  kit::Json all = kit::Json::array();
  for (const Result& result : results) {
    const Row& first = result.rows.front();
    kit::Json rows = kit::Json::array();
    for (const Row& row : result.rows)
      rows.push_back({{"iterations", row.iterations},
                      {"grain_us", rounded(1e6 * row.grain_seconds)},
                      {"seconds", rounded(row.seconds)},
                      {"tasks", row.n_tasks},
                      {"dependences", row.n_dependences},
                      {"efficiency", rounded(row.efficiency)}});
    kit::Json one = {
        {"type", first.type},     {"kernel", first.kernel},  {"width", first.width},
        {"steps", first.steps},   {"pes", first.pes},        {"ranks", first.ranks},
        {"metg_us", nullptr},     {"metg_wall_us", nullptr}, {"metg_is_upper_bound", false},
        {"rows", std::move(rows)}};
    if (result.metg) {
      one["metg_us"] = rounded(1e6 * result.metg->grain_seconds);
      one["metg_wall_us"] = rounded(1e6 * result.metg->wall_seconds);
      one["metg_is_upper_bound"] = result.metg->below;
    }
    all.push_back(std::move(one));
  }
  const kit::Json file = {{"machine", machine}, {"results", std::move(all)}};
  kit::write_file(path, kit::json_text(file));
}

void write_csv(const std::string& path, const std::vector<Result>& results) {
  std::string text =
      "type,kernel,width,steps,pes,ranks,iterations,tasks,dependences,grain_us,seconds,"
      "efficiency\n";
  for (const Result& result : results)
    for (const Row& row : result.rows)
      text += fmt::format("{},{},{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g}\n", row.type, row.kernel,
                          row.width, row.steps, row.pes, row.ranks, row.iterations, row.n_tasks,
                          row.n_dependences, 1e6 * row.grain_seconds, row.seconds, row.efficiency);
  kit::write_file(path, text);
}

void draw(const std::string& path, const std::vector<Result>& results) {
  const Row& first = results.front().rows.front();
  kit::Chart chart{.title = fmt::format("Task Bench, {} PEs on {} ranks", first.pes, first.ranks),
                   .x_label = "kernel of one task, us",
                   .y_label = "efficiency",
                   .x_log = true};
  double least = 1e300, most = 0;
  for (const Result& result : results) {
    kit::Series series{.name = result.rows.front().type};
    for (const Row& row : result.rows) {
      series.points.push_back({1e6 * row.grain_seconds, row.efficiency});
      least = std::min(least, 1e6 * row.grain_seconds);
      most = std::max(most, 1e6 * row.grain_seconds);
    }
    chart.series.push_back(std::move(series));
  }
  chart.series.push_back(
      {.name = "one half", .points = {{least, 0.5}, {most, 0.5}}, .style = kit::Style::dashes});
  (void)kit::write_svg(path, chart);
}

}  // namespace task_bench
