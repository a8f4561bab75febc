#include "apps/collide_scene/output/report.hpp"

#include "apps/kit/rows.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace collide_scene {
namespace {

using tess::collide::WithinModel;

double ns_per_object(const Report& report) {
  return report.n_objects == 0
             ? 0
             : report.result.seconds_per_step() * 1e9 / static_cast<double>(report.n_objects);
}

template <class T>
std::string number(T value) {
  return fmt::format("{:.6g}", static_cast<double>(value));
}

const char* kind_of_objects(const Report& report) {
  return report.n_triangles > 0 ? "triangles" : "boxes";
}

std::string pairs_in_words(const Report& report) {
  const Rules& rules = report.options.rules;
  return fmt::format("{}{}, {}",
                     rules.triangles          ? "triangles that intersect"
                     : report.n_triangles > 0 ? "boxes of triangles that overlap"
                                              : "boxes that overlap",
                     rules.open ? " (touching does not count)" : "",
                     report.n_models == 0                      ? "no models"
                     : rules.within_model == WithinModel::test ? "between and within models"
                                                               : "between models");
}

struct StepRow {
  std::size_t step = 0;
  StepResult result;
  std::size_t n_objects = 0;
};
using R = const StepRow&;
using kit::Json;

constexpr kit::Column<StepRow> columns[] = {
    {"step", "step", "8", kit::of<&StepRow::step>},
    {"candidates", "candidates", "12", [](R r) -> Json { return r.result.answer.n_candidates; }},
    {"pairs", "pairs", "12", [](R r) -> Json { return r.result.answer.n_pairs; }},
    {"searched", "", nullptr, [](R r) -> Json { return r.result.searched; }},
    {"kept", "", nullptr, [](R r) -> Json { return r.result.n_kept; }},
    {"", "ms", "12.4f", [](R r) -> Json { return 1e3 * r.result.seconds; }},
    {"", "ns/object", "12.2f",
     [](R r) -> Json { return 1e9 * r.result.seconds / static_cast<double>(r.n_objects); }},
    {"seconds", "", nullptr, [](R r) -> Json { return r.result.seconds; }}};

const kit::Rows<StepRow>& step_report() {
  static const kit::Rows<StepRow> rows(columns);
  return rows;
}

std::vector<StepRow> rows_of(const Report& report) {
  std::vector<StepRow> rows;
  for (const StepResult& step : report.result.steps)
    rows.push_back({rows.size(), step, report.n_objects});
  return rows;
}

std::string slack_in_words(const RunResult& result) {
  const bool keeps = std::ranges::any_of(result.steps, [](const auto& s) { return s.n_kept != 0; });
  return fmt::format("{} of {} steps searched{}", result.n_searched(), result.steps.size(),
                     keeps ? "; the others tested pairs that were kept"
                           : "; no pair was kept: there is none, or they are too many");
}

}  // namespace

std::string explanation(const Report& report) {
  const Rules& rules = report.options.rules;
  std::string out = "this run\n";
  const auto line = [&out](const char* name, const std::string& value) {
    out += fmt::format("  {:<14} {}\n", name, value);
  };
  line("objects", fmt::format("{} {}", report.n_objects, kind_of_objects(report)));
  line("pairs", pairs_in_words(report));
  line("exact tests", rules.triangles ? "used, of pairs of triangles whose boxes overlap"
                      : report.n_triangles > 0
                          ? "left out of the run (--triangles); made once after it, untimed"
                          : "left out: the objects are boxes");
  line("slack", rules.slack > 0
                    ? fmt::format("{} (--slack): pairs of larger boxes are kept", rules.slack)
                    : "left out: each step searches, and no pair is kept");
  line("capsules", rules.slack > 0   ? "left out: kept pairs are of boxes"
                   : rules.triangles ? "used if most triangles are long and thin: pairs whose "
                                       "capsules are apart are not tested"
                                     : "left out: boxes that overlap are pairs");
  line("models", report.n_models == 0
                     ? "left out: every pair counts"
                     : fmt::format("{}: {}", report.n_models,
                                   rules.within_model == WithinModel::test
                                       ? "no voxel is left out"
                                       : "voxels that one model alone touches are left out"));
  if (report.n_models == 1 && rules.within_model == WithinModel::skip)
    line("", "one model has no pairs: --self tests pairs within it");
  line("voxel size", rules.voxel_size > 0 ? fmt::format("{} (--voxel-size)", rules.voxel_size)
                                          : "chosen from the objects");
  line("motion", report.motion);
  line("runtime",
       report.on_chares
           ? fmt::format("used: {}; a client per PE owns a piece of the objects", report.machine)
           : "left out: one thread, the serial face");
  line("pairs kept", report.options.out.empty() ? "left out: they are counted and hashed"
                                                : "those of the last step, for --out");
  return out;
}

std::string table(const Report& report) {
  const RunResult& result = report.result;
  const GridReport& grid = result.grid;
  const tess::collide::GridCounts& counts = grid.counts;
  std::string out = report.scene + "\n";
  const auto line = [&out](const char* name, const std::string& value) {
    out += fmt::format("  {:<10} {}\n", name, value);
  };
  line("machine", report.on_chares ? report.machine : "one thread, without the runtime");
  line("pairs", pairs_in_words(report));
  if (report.n_models == 1 && report.options.rules.within_model == WithinModel::skip)
    line("", "there is one model, so there are no pairs; --self finds those within it");
  line("grid",
       fmt::format("voxel size {}, {} levels, {} voxels, {} entries, {} objects left out",
                   number(counts.voxel_size), number(counts.n_levels), number(counts.n_voxels),
                   number(counts.n_entries), number(counts.n_left_out)));
  if (grid.pieces.value_or(0) != 0)
    line("", *grid.pieces == report.n_objects
                 ? "long thin triangles, whole, by their capsules"
                 : fmt::format("{} pieces of long thin triangles", *grid.pieces));
  if (report.options.rules.slack > 0) line("slack", slack_in_words(result));
  out += step_report().head();
  constexpr std::size_t most_rows = 20;
  const std::vector<StepRow> rows = rows_of(report);
  const std::size_t n_left_out = rows.size() > most_rows ? rows.size() - most_rows : 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (n_left_out > 0 && i == most_rows / 2) {
      out += fmt::format("  {:>6} ({} steps)\n", "…", n_left_out);
      i += n_left_out;
    }
    out += step_report().line(rows[i]);
  }
  line("error", report.false_positive_rate
                    ? fmt::format("{:.2f} % of the candidates of the last step are no pairs of {}",
                                  100 * *report.false_positive_rate, kind_of_objects(report))
                    : "not measured: too many candidates (--triangles measures it)");
  line("time", fmt::format("{:.6f} s per step, {:.2f} ns per object; peak memory {:.1f} MB",
                           result.seconds_per_step(), ns_per_object(report),
                           static_cast<double>(result.peak_memory_bytes) / 1e6));
  line("result", kit::hex(result.total().hash));
  return out;
}

Json json(const Report& report) {
  const RunResult& result = report.result;
  const Answer total = result.total();
  const tess::collide::GridCounts& grid = result.grid.counts;
  return {{"scene", report.scene},
          {"inputs", report.options.inputs},
          {"objects", report.n_objects},
          {"triangles", report.n_triangles},
          {"models", report.n_models},
          {"pairs", total.n_pairs},
          {"candidates", total.n_candidates},
          {"false_positive_rate", report.false_positive_rate},
          {"voxel_size", grid.voxel_size},
          {"levels", grid.n_levels},
          {"voxels", grid.n_voxels},
          {"entries", grid.n_entries},
          {"left_out", grid.n_left_out},
          {"pieces", result.grid.pieces},
          {"grid_bytes", result.grid.bytes},
          {"slack", report.options.rules.slack},
          {"searches", result.n_searched()},
          {"seconds_per_step", result.seconds_per_step()},
          {"ns_per_object", ns_per_object(report)},
          {"peak_memory_bytes", result.peak_memory_bytes},
          {"result_hash", kit::hex(total.hash)},
          {"machine", report.on_chares ? report.machine : "one thread"},
          {"pes", report.n_pes},
          {"processes", report.n_processes},
          {"steps", step_report().json(rows_of(report))}};
}

}  // namespace collide_scene
