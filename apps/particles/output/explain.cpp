#include "apps/particles/output/report.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace particles {
namespace {

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

}  // namespace particles
