#include "apps/particles/output/report.hpp"

#include "apps/kit/rows.hpp"

#include <algorithm>
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

template <auto member>
Json measure(const Row& row) {
  return row.measured.*member;
}

constexpr kit::Column<Row> columns[] = {
    {"step", "step", "10", kit::of<&Row::step>},
    {"time", "time", "12", kit::of<&Row::time>},
    {"particles", "particles", "12", measure<&Measured::particles>},
    {"blocks", "blocks", "10", measure<&Measured::blocks>},
    {"kinetic", "kinetic", "12", [](const Row& r) -> Json { return r.measured.kinetic.total(); }},
    {"energy", "energy", "12", [](const Row& r) -> Json { return r.measured.energy(); }},
    {"fastest", "fastest", "12", measure<&Measured::fastest>},
    {"nearest", "nearest", "12", measure<&Measured::nearest>},
    {"inside", "inside", "12", measure<&Measured::inside>},
    {"tunnelled", "tunnelled", "12", measure<&Measured::tunnelled>},
    {"nonfinite", "nonfinite", "12", measure<&Measured::nonfinite>}};
const kit::Rows<Row>& measures() {
  static const kit::Rows<Row> rows(columns);
  return rows;
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

/// A value in a line; "-" for null.
std::string shown(const Json& value) {
  if (value.kind() == Json::Kind::null) return "-";
  return value.kind() == Json::Kind::real ? fmt::format("{:.6g}", value.real()) : value.text();
}

/// "used, by rules, the picture (outputs.slice)", or "left out".
std::string uses(const Scene& scene, bool rules) {
  std::string out;
  const auto add = [&out](bool is_used, const char* by) {
    if (is_used) out += (out.empty() ? "used, by " : ", ") + std::string(by);
  };
  add(rules, "rules");
  add(scene.outputs.slice.has_value(), "the picture (outputs.slice)");
  add(scene.outputs.fields, "the files (outputs.fields)");
  return out.empty() ? "left out" : out;
}

}  // namespace

std::string explanation(const Scene& scene, const RunOptions& options) {
  std::string out = "this scene, rule by rule\n";
  const auto line = [&out](const std::string& text) { out += "  " + text + "\n"; };
  const auto count = [&scene](const auto& is_counted) {
    return std::ranges::count_if(scene.objects, is_counted);
  };
  for (const std::string& rule : tess::dn::explain(scene.rules)) line(rule);
  const bool any = !scene.objects.empty(), needs = any && needs_field(scene.rules);
  line("distances: " + uses(scene, needs));
  const bool normals = needed_content(scene.rules) == tess::dn::Content::distance_and_normal;
  line("normals: " + uses(scene, needs && (normals || scene.compression)));
  if (any && builds_fields(scene)) {
    const auto n_read = count([](const SceneObject& object) { return !object.field.empty(); });
    line(fmt::format("fields: {} built, {} read from files",
                     static_cast<std::ptrdiff_t>(scene.objects.size()) - n_read, n_read));
    line(scene.compression ? fmt::format("compression: used, within {} cells and {} degrees",
                                         scene.compression->cells, scene.compression->degrees)
                           : "compression: left out, flat fields");
  } else if (any) {
    line("fields: left out, no rule asks for a surface and no picture shows one");
  }
  line(fmt::format("objects: {}, of which {} move", scene.objects.size(),
                   count([](const SceneObject& object) { return object.frame.is_moving(); })));
  line(fmt::format("step loops: {}, one for each mass", masses_of(scene).size()));
  line(
      fmt::format("audit of each step for particles that tunnel: of {} of {} particles "
                  "(outputs.audit); their steps take 4 to 10 times as long",
                  n_audited(scene), scene.n_particles()));
  const auto& balance = options.balance;
  line(balance ? fmt::format("balancer: used, {}, {}", balance->strategy, name_of(balance->when))
               : "balancer: left out, blocks stay and no load is measured");
  if (scene.outputs.trajectories == 0) line("trajectories: left out");
  return out;
}

Json report(const Scene& scene, const RunResult& result, const RunOptions& options) {
  const Measured& begin = result.rows.front().measured;
  const Measured& end = result.rows.back().measured;
  const FieldCost& fields = result.fields;
  const double n = static_cast<double>(scene.n_particles()) * scene.steps;
  const auto per_particle_step = [n](double seconds) { return n > 0 ? seconds * 1e9 / n : 0; };
  Json out = {{"scene", scene.name},
              {"particles", scene.n_particles()},
              {"steps", scene.steps},
              {"dt", scene.dt},
              {"pes", tess::n_pes()},
              {"processes", tess::machine().n_processes()},
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
  if (const auto& balance = options.balance)
    out["balance"] = balance_of(balance->strategy, balance->when, result.rounds);
  out["result_hash"] = kit::hex(end.hash);
  out["measures"] = measures().json(result.rows);
  return out;
}

std::string table(const Json& report, const RunResult& result) {
  std::string out;
  for (const auto& [key, value] : report.members()) {
    if (key == "measures") continue;
    const bool has_parts = value.kind() == Json::Kind::object;
    std::string text = has_parts ? "" : shown(value);
    if (has_parts)
      for (const auto& [name, part] : value.members())
        text += (text.empty() ? "" : ", ") + name + " " + shown(part);
    out += fmt::format("  {:<20} {}\n", key, text);
  }
  return out + measures().table(result.rows);
}

}  // namespace particles
