#include "apps/particles/output/report.hpp"

#include <algorithm>
#include <array>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace particles {
namespace {

// In the order of BalanceWhen.
constexpr std::array when_names{"at_sync", "periodic", "automatic"};

/// The balancer's rounds of a run, summed.
struct Balanced {
  explicit Balanced(const std::vector<tess::balance::Round>& of) : rounds(of.size()) {
    for (const tess::balance::Round& round : of) {
      moves += round.n_moved;
      bytes += round.moved_bytes;
      seconds += round.round_seconds;
    }
  }
  std::uint64_t rounds, moves = 0, bytes = 0;
  double seconds = 0;
};

std::string_view method_of(const Scene& scene) {
  if (scene.objects.empty()) return "none";
  const auto method = scene.objects.front().method;
  for (const SceneObject& object : scene.objects)
    if (object.method != method) return "mixed";
  return name_of(method);
}

double per_particle_step(const Scene& scene, double seconds) {
  const double n = static_cast<double>(scene.n_particles()) * scene.steps;
  return n > 0 ? seconds * 1e9 / n : 0;
}

nlohmann::ordered_json json_of(const Row& row, double dt) {
  const Measured& m = row.measured;
  nlohmann::ordered_json out = {
      {"step", row.step},         {"time", row.step * dt},
      {"blocks", m.blocks},       {"kinetic", m.kinetic.total()},  // null where it is not finite
      {"energy", m.energy()},     {"fastest", m.fastest},
      {"nearest", m.nearest},     {"inside", m.inside},
      {"tunnelled", m.tunnelled}, {"nonfinite", m.nonfinite}};
  if (!(m.nearest < HUGE_VAL)) out.erase("nearest");
  return out;
}

nlohmann::ordered_json json_of(const StudyRow& row) {
  nlohmann::ordered_json out;
  out["part"] = row.part;
  out["resolution"] = row.resolution;
  out["method"] = row.method;
  if (!row.note.empty()) {
    out["refused"] = row.note;
    return out;
  }
  out["stored"] = row.stored;
  out["look_up"] = row.look_up;
  out["rule"] = row.rule;
  for (const StudyColumn& column : study_columns())
    if (row.*column.value >= 0) out[column.name] = row.*column.value;
  return out;
}

}  // namespace

std::string table(const Scene& scene, const RunResult& result, const Report& report) {
  const FieldCost& fields = result.fields;
  std::string out = fmt::format("{}: {} particles, {} steps of {}\n", scene.name,
                                scene.n_particles(), scene.steps, scene.dt);
  const auto line = [&out](const char* name, const std::string& value) {
    out += fmt::format("  {:<10} {}\n", name, value);
  };
  line("machine", report.machine);
  if (fields.cells > 0)
    line("fields",
         fmt::format("{} of method {}, {} cells, {:.3f} MB{}, made in {:.3f} s",
                     scene.objects.size(), method_of(scene), fields.cells,
                     static_cast<double>(fields.bytes) / 1e6,
                     scene.compression ? fmt::format(" compressed to {:.3f} MB",
                                                     static_cast<double>(fields.bytes_used) / 1e6)
                                       : "",
                     fields.build_seconds));
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (object.thin_share == 0) continue;
    line("thin",
         fmt::format("{:.2g} % of objects[{}] is thinner than {:.3g}: particles may pass there",
                     100 * object.thin_share, i, least_wall(scene.rules, object)));
  }
  line("blocks", fmt::format("of {:.4g}, particles change them every {} steps", result.block,
                             result.exchange));
  out += fmt::format("  {:>9} {:>10} {:>9} {:>7} {:>13} {:>13} {:>10} {:>10} {:>8} {:>9} {:>9}\n",
                     "step", "time", "particles", "blocks", "kinetic", "energy", "fastest",
                     "nearest", "inside", "tunnelled", "nonfinite");
  for (const auto& [step, m] : result.rows)
    out += fmt::format(
        "  {:>9} {:>10.4g} {:>9} {:>7} {:>13.6e} {:>13.6e} {:>10.4g} {:>10} {:>8} {:>9} {:>9}\n",
        step, step * scene.dt, m.particles, m.blocks, m.kinetic.total(), m.energy(), m.fastest,
        m.nearest < HUGE_VAL ? fmt::format("{:.4g}", m.nearest) : "-", m.inside, m.tunnelled,
        m.nonfinite);
  line("time", fmt::format("{:.4f} s, {:.3f} ns per particle and step; CPU in the rules {:.3f} ns",
                           result.seconds, per_particle_step(scene, result.seconds),
                           per_particle_step(scene, result.loop_seconds)));
  if (result.audited > 0)
    line("audit", fmt::format("of {} particles in each step: CPU {:.3f} ns per particle and step",
                              result.audited, per_particle_step(scene, result.audit_seconds)));
  if (const auto& balance = report.run.balance) {
    const Balanced of(result.rounds);
    line("balance",
         fmt::format("{}: {} rounds moved {} blocks, {:.3f} MB, in {:.4f} s", balance->strategy,
                     of.rounds, of.moves, static_cast<double>(of.bytes) / 1e6, of.seconds));
  }
  line("result", fmt::format("{:016x}", result.rows.back().measured.hash));
  return out;
}

std::string json(const Scene& scene, const RunResult& result, const Report& report) {
  const Measured& begin = result.rows.front().measured;
  const Measured& end = result.rows.back().measured;
  const FieldCost& fields = result.fields;
  nlohmann::ordered_json out = {{"scene", scene.name},
                                {"particles", scene.n_particles()},
                                {"steps", scene.steps},
                                {"dt", scene.dt},
                                {"pes", report.pes},
                                {"processes", report.processes},
                                {"machine", report.machine},
                                {"ns_per_particle_step", per_particle_step(scene, result.seconds)},
                                {"ns_in_rules", per_particle_step(scene, result.loop_seconds)},
                                {"ns_in_audit", per_particle_step(scene, result.audit_seconds)},
                                {"seconds", result.seconds}};
  out["field"] = {{"method", method_of(scene)},
                  {"cells", fields.cells},
                  {"build_seconds", fields.build_seconds},
                  {"bytes", fields.bytes},
                  {"bytes_compressed", nullptr},  // of a run with flat fields
                  {"stored", scene.compression ? "compressed" : "flat"}};
  if (scene.compression) out["field"]["bytes_compressed"] = fields.bytes_used;
  out["nonfinite"] = end.nonfinite;
  out["tunnelled"] = end.tunnelled;
  out["tunnelled_found_by"] = result.audited == 0                     ? "last step"
                              : result.audited == scene.n_particles() ? "each step"
                                                                      : "sampled";
  out["audited"] = result.audited;
  out["energy_start"] = begin.energy();
  out["energy_end"] = end.energy();
  out["block"] = result.block;
  out["exchange"] = result.exchange;
  if (const auto& balance = report.run.balance) {
    const Balanced of(result.rounds);
    out["balance"] = {{"strategy", balance->strategy},
                      {"when", when_names[static_cast<std::size_t>(balance->when)]},
                      {"rounds", of.rounds},
                      {"moves", of.moves},
                      {"bytes", of.bytes},
                      {"seconds", of.seconds}};
  }
  out["result_hash"] = fmt::format("{:016x}", end.hash);
  out["rows"] = nlohmann::ordered_json::array();
  for (const Row& row : result.rows) out["rows"].push_back(json_of(row, scene.dt));
  out["study"] = nlohmann::ordered_json::array();
  for (const StudyRow& row : report.study) out["study"].push_back(json_of(row));
  // The name of a file may have any bytes; JSON holds only UTF-8.
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace particles
