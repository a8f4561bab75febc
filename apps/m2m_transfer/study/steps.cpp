#include "apps/m2m_transfer/study/steps.hpp"

#include "apps/m2m_transfer/run/steps.hpp"

#include <algorithm>
#include <array>

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
  std::vector<DistributedMesh> meshes = co_await place(problem);
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

const kit::Rows<StepsRow>& steps_rows() {
  using R = const StepsRow&;
  using kit::Json;
  using kit::of;
  static constexpr kit::Column<StepsRow> columns[] = {
      {"source", "source", "<", of<&StepsRow::source>},
      {"target", "target", "<", of<&StepsRow::target>},
      {"steps", "steps", "6", of<&StepsRow::steps>},
      {"seconds_per_step_kept", "kept, s/step", "14.6f", of<&StepsRow::kept>},
      {"seconds_per_step_again", "again, s/step", "14.6f", of<&StepsRow::again>},
      {"", "gain", "7.1f", [](R r) -> Json { return r.again / r.kept; }},
      {"same_bits", "same bits", "<", [](R r) -> Json { return r.ok(); }},
      {"result_hash", "", nullptr, [](R r) -> Json { return kit::hex(r.hash); }},
      {"", "", "<", [](R r) -> Json { return r.ok() ? "" : "FAILED"; }}};
  static const kit::Rows<StepsRow> rows(columns);
  return rows;
}

Picture picture_of(const std::vector<StepsRow>& rows) {
  kit::Chart chart{.title = "the time of a step with donors that are kept",
                   .x_label = "steps",
                   .y_label = "seconds per step",
                   .x_log = true,
                   .y_log = true};
  for (const StepsRow& row : rows) {
    const std::string name = row.source + " -> " + row.target;
    kit::add_point(chart, name, row.steps, row.kept);
    kit::add_point(chart, name + ", again", row.steps, row.again);
    chart.series.back().style = kit::Style::dashes;
  }
  return {"steps_time", std::move(chart)};
}

}  // namespace m2m_transfer
