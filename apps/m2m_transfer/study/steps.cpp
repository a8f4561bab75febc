#include "apps/m2m_transfer/study/steps.hpp"

#include "apps/kit/chart.hpp"
#include "apps/kit/json.hpp"
#include "apps/kit/quoting.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/m2m_transfer/run/steps.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

constexpr std::array counts{1, 2, 5, 10, 20, 50, 100};

Task run_steps(Problem& problem, std::vector<DistributedMesh>& meshes, std::int32_t steps,
               kit::Progress& progress, double& seconds) {
  problem.steps = steps;
  const Time begin = now();
  GraphRun graph(problem, meshes, progress);
  co_await graph.search();
  co_await graph.steps();
  const double mine = seconds_since(begin);
  seconds = seconds == 0 ? mine : std::min(seconds, mine);
  co_await graph.destroy();
}

TaskOf<std::uint64_t> hash_of(const Problem& problem, const std::vector<DistributedMesh>& meshes) {
  return hash_values(meshes[1], problem.meshes[1].survey.n_points,
                     scalar_columns(problem.field_names.size()));
}

}  // namespace

Task measure_steps(Problem& problem, std::int32_t repeat, kit::Progress& progress,
                   std::vector<StepsRow>& rows) {
  progress.phase("partition");
  std::vector<DistributedMesh> meshes = co_await place(problem, problem.kind, problem.chares());
  double warm = 0, again = 0;
  co_await run_steps(problem, meshes, 1, progress, warm);
  for (std::int32_t round = 0; round < repeat; ++round)
    co_await run_steps(problem, meshes, 1, progress, again);
  const std::uint64_t hash_again = co_await hash_of(problem, meshes);
  for (const int steps : counts) {
    StepsRow row{problem.meshes[0].name, problem.meshes[1].name, steps, 0, again, 0, hash_again};
    double whole = 0;
    for (std::int32_t round = 0; round < repeat; ++round)
      co_await run_steps(problem, meshes, steps, progress, whole);
    row.kept = whole / steps;
    row.hash = co_await hash_of(problem, meshes);
    rows.push_back(std::move(row));
  }
  co_await destroy(meshes);
}

std::string table(const std::vector<StepsRow>& rows) {
  std::size_t wide = 6;
  for (const StepsRow& row : rows) wide = std::max({wide, row.source.size(), row.target.size()});
  std::string out =
      fmt::format("{:<{}} {:<{}} {:>6} {:>14} {:>14} {:>7}  {}\n", "source", wide, "target", wide,
                  "steps", "kept, s/step", "again, s/step", "gain", "same bits");
  for (const StepsRow& row : rows)
    out += fmt::format("{:<{}} {:<{}} {:>6} {:>14.6f} {:>14.6f} {:>7.1f}  {}\n", row.source, wide,
                       row.target, wide, row.steps, row.kept, row.again, row.again / row.kept,
                       row.ok() ? "yes" : "no  FAILED");
  return out + "kept: one search, then the steps; again: a search in every step\n";
}

std::string json(const std::vector<StepsRow>& rows) {
  kit::Json whole;
  for (const StepsRow& row : rows)
    whole["rows"].push_back({{"source", row.source},
                             {"target", row.target},
                             {"steps", row.steps},
                             {"seconds_per_step_kept", row.kept},
                             {"seconds_per_step_again", row.again},
                             {"same_bits", row.ok()},
                             {"result_hash", fmt::format("{:016x}", row.hash)}});
  return kit::json_text(whole);
}

std::string write(const std::vector<StepsRow>& rows, const std::string& folder) {
  std::string csv = "source,target,steps,kept,again,same_bits,result_hash\n";
  kit::Chart chart{.title = "the time of a step with donors that are kept",
                   .x_label = "steps",
                   .y_label = "seconds per step",
                   .x_log = true,
                   .y_log = true};
  for (const StepsRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{},{:016x}\n", kit::csv_field(row.source),
                       kit::csv_field(row.target), row.steps, row.kept, row.again,
                       row.ok() ? "yes" : "no", row.hash);
    const std::string name = row.source + " -> " + row.target;
    if (chart.series.empty() || chart.series.back().name != name + ", again") {
      chart.series.push_back({name});
      chart.series.push_back({name + ", again", {}, kit::Style::dashes});
    }
    const auto x = static_cast<double>(row.steps);
    chart.series[chart.series.size() - 2].points.push_back({x, row.kept});
    chart.series.back().points.push_back({x, row.again});
  }
  kit::write_file(folder + "/steps.csv", csv);
  kit::write_file(folder + "/steps.json", json(rows));
  const bool drawn = kit::write_svg(folder + "/steps.svg", chart);
  return fmt::format("written: {}/steps.csv, steps.json{}\n", folder, drawn ? ", steps.svg" : "");
}

}  // namespace m2m_transfer
