#include "apps/collide_scene/output/report.hpp"

#include "apps/kit/json.hpp"

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
  out += fmt::format("  {:>6} {:>12} {:>12} {:>12} {:>12}\n", "step", "candidates", "pairs", "ms",
                     "ns/object");
  constexpr std::size_t most_rows = 20;
  const std::size_t n = result.steps.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (n > most_rows && i == most_rows / 2) {
      out += fmt::format("  {:>6} ({} steps)\n", "…", n - most_rows);
      i = n - most_rows / 2;
    }
    const StepResult& step = result.steps[i];
    out += fmt::format("  {:>6} {:>12} {:>12} {:>12.4f} {:>12.2f}\n", i, step.answer.n_candidates,
                       step.answer.n_pairs, step.seconds * 1e3,
                       step.seconds * 1e9 / static_cast<double>(report.n_objects));
  }
  line("error", report.false_positive_rate
                    ? fmt::format("{:.2f} % of the candidates of the last step are no pairs of {}",
                                  100 * *report.false_positive_rate, kind_of_objects(report))
                    : "not measured: too many candidates (--triangles measures it)");
  line("time", fmt::format("{:.6f} s per step, {:.2f} ns per object; peak memory {:.1f} MB",
                           result.seconds_per_step(), ns_per_object(report),
                           static_cast<double>(result.peak_memory_bytes) / 1e6));
  line("result", fmt::format("{:016x}", result.total().hash));
  return out;
}

std::string json(const Report& report) {
  const RunResult& result = report.result;
  const Answer total = result.total();
  kit::Json out;
  const auto set = [&out](const char* key, const auto& value) {
    if (value)
      out[key] = *value;
    else
      out[key] = nullptr;
  };
  out["scene"] = report.scene;
  out["inputs"] = report.options.inputs;
  out["objects"] = report.n_objects;
  out["triangles"] = report.n_triangles;
  out["models"] = report.n_models;
  out["steps"] = result.steps.size();
  out["pairs"] = total.n_pairs;
  out["candidates"] = total.n_candidates;
  set("false_positive_rate", report.false_positive_rate);
  const tess::collide::GridCounts& grid = result.grid.counts;
  out["voxel_size"] = grid.voxel_size;
  out["levels"] = grid.n_levels;
  out["voxels"] = grid.n_voxels;
  out["entries"] = grid.n_entries;
  out["left_out"] = grid.n_left_out;
  set("pieces", result.grid.pieces);
  set("grid_bytes", result.grid.bytes);
  out["slack"] = report.options.rules.slack;
  out["searches"] = result.n_searched();
  out["seconds_per_step"] = result.seconds_per_step();
  out["ns_per_object"] = ns_per_object(report);
  out["peak_memory_bytes"] = result.peak_memory_bytes;
  out["result_hash"] = fmt::format("{:016x}", total.hash);
  out["machine"] = report.on_chares ? report.machine : "one thread";
  out["pes"] = report.n_pes;
  out["processes"] = report.n_processes;
  out["rows"] = kit::Json::array();
  for (std::size_t i = 0; i < result.steps.size(); ++i)
    out["rows"].push_back({{"step", i},
                           {"pairs", result.steps[i].answer.n_pairs},
                           {"candidates", result.steps[i].answer.n_candidates},
                           {"searched", result.steps[i].searched},
                           {"kept", result.steps[i].n_kept},
                           {"seconds", result.steps[i].seconds}});
  return kit::json_text(out);
}

}  // namespace collide_scene
