#include "apps/particles/output/report.hpp"

#include "apps/kit/json.hpp"

#include <fmt/core.h>

namespace particles {
namespace {
using kit::Json;

std::string_view method_of(const Scene& scene) {
  if (scene.objects.empty()) return "none";
  const auto method = scene.objects.front().method;
  for (const SceneObject& object : scene.objects)
    if (object.method != method) return "mixed";
  return name_of(method);
}

/// Numbers that are not finite become null.
Json json_of(const Row& row, double dt) {
  const Measured& m = row.measured;
  return {{"step", row.step},         {"time", row.step * dt},        {"particles", m.particles},
          {"blocks", m.blocks},       {"kinetic", m.kinetic.total()}, {"energy", m.energy()},
          {"fastest", m.fastest},     {"nearest", m.nearest},         {"inside", m.inside},
          {"tunnelled", m.tunnelled}, {"nonfinite", m.nonfinite}};
}

Json json_of(const StudyRow& row) {
  Json out{
      {"part", row.part}, {"resolution", static_cast<int>(row.resolution)}, {"method", row.method}};
  if (!row.note.empty()) {
    out["refused"] = row.note;
    return out;
  }
  out["stored"] = row.stored;
  out["look_up"] = row.look_up;
  out["rule"] = row.rule;
  for (const StudyColumn& column : study_columns())
    if (row.*column.value != not_measured) out[column.name] = row.*column.value;
  return out;
}

Json balance_of(const std::string& strategy, tess::BalanceWhen when,
                const std::vector<tess::balance::Round>& rounds) {
  std::uint64_t moves = 0, bytes = 0;
  double seconds = 0;
  for (const tess::balance::Round& round : rounds)
    moves += round.n_moved, bytes += round.moved_bytes, seconds += round.round_seconds;
  return {{"strategy", strategy}, {"when", name_of(when)}, {"rounds", rounds.size()},
          {"moves", moves},       {"bytes", bytes},        {"seconds", seconds}};
}

/// The whole report but the study.
Json document(const Scene& scene, const RunResult& result, const Report& report) {
  const Measured& begin = result.rows.front().measured;
  const Measured& end = result.rows.back().measured;
  const FieldCost& fields = result.fields;
  const double n = static_cast<double>(scene.n_particles()) * scene.steps;
  const auto per_particle_step = [n](double seconds) { return n > 0 ? seconds * 1e9 / n : 0; };
  Json out = {{"scene", scene.name},
              {"particles", scene.n_particles()},
              {"steps", scene.steps},
              {"dt", scene.dt},
              {"pes", report.pes},
              {"processes", report.processes},
              {"machine", report.machine},
              {"ns_per_particle_step", per_particle_step(result.seconds)},
              {"ns_in_rules", per_particle_step(result.loop_seconds)},
              {"ns_in_audit", per_particle_step(result.audit_seconds)},
              {"seconds", result.seconds}};
  out["field"] = {{"method", method_of(scene)},
                  {"cells", fields.cells},
                  {"build_seconds", fields.build_seconds},
                  {"bytes", fields.bytes},
                  {"bytes_compressed", nullptr},  // of a run with flat fields
                  {"stored", scene.compression ? "compressed" : "flat"}};
  if (scene.compression) out["field"]["bytes_compressed"] = fields.bytes_used;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (const double share = scene.objects[i].thin_share; share > 0)
      out["thin"][fmt::format("objects[{}]", i)] =
          fmt::format("{:.2g} % of it is thinner than {:.3g}: particles may pass there",
                      100 * share, least_wall(scene.rules, scene.objects[i]));
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (const auto& surface = scene.objects[i].surface; !surface.remarks.empty())
      out["surface"][fmt::format("objects[{}]", i)] = remarks_text(surface);
  out["nonfinite"] = end.nonfinite;
  if (begin.inside != 0) {
    out["began_inside"] = begin.inside;
    out["remedy"] = fmt::format(
        "{} of {} particles begin below a surface, and {} are below one at the end: rules act from "
        "outside; move the emitters",
        begin.inside, begin.particles, end.inside);
  }
  out["tunnelled"] = end.tunnelled;
  out["tunnelled_found_by"] = result.audited == 0                     ? "last step"
                              : result.audited == scene.n_particles() ? "each step"
                                                                      : "sampled";
  out["audited"] = result.audited;
  out["energy_start"] = begin.energy();
  out["energy_end"] = end.energy();
  out["block"] = result.block;
  out["exchange"] = result.exchange;
  if (const auto& balance = report.run.balance)
    out["balance"] = balance_of(balance->strategy, balance->when, result.rounds);
  out["result_hash"] = fmt::format("{:016x}", end.hash);
  out["rows"] = Json::array();
  for (const Row& row : result.rows) out["rows"].push_back(json_of(row, scene.dt));
  return out;
}

/// A value in a table; "-" for null.
std::string shown(const Json& value) {
  if (value.kind() == Json::Kind::null) return "-";
  return value.kind() == Json::Kind::real ? fmt::format("{:.6g}", value.real()) : value.text();
}

}  // namespace

std::string table(const Scene& scene, const RunResult& result, const Report& report) {
  std::string out;
  const Json whole = document(scene, result, report);
  for (const auto& [key, value] : whole.members()) {
    if (key == "rows") continue;
    const bool has_parts = value.kind() == Json::Kind::object;
    std::string text = has_parts ? "" : shown(value);
    if (has_parts)
      for (const auto& [name, part] : value.members())
        text += (text.empty() ? "" : ", ") + name + " " + shown(part);
    out += fmt::format("  {:<20} {}\n", key, text);
  }
  const std::vector<Json::Member>& rows = whole.at("rows").members();
  for (const auto& [name, value] : rows.front().value.members())
    out += fmt::format(" {:>12}", name);
  for (const Json::Member& row : rows) {
    out += '\n';
    for (const auto& [name, value] : row.value.members())
      out += fmt::format(" {:>12}", shown(value));
  }
  return out + '\n';
}

std::string json(const Scene& scene, const RunResult& result, const Report& report) {
  Json out = document(scene, result, report);
  out["study"] = Json::array();
  for (const StudyRow& row : report.study) out["study"].push_back(json_of(row));
  return kit::json_text(out);
}

}  // namespace particles
