#include "apps/particles/output/explain.hpp"

#include "apps/particles/simulation/simulate.hpp"

#include <algorithm>
#include <array>
#include <fmt/core.h>

namespace particles {
namespace {

// In the order of BalanceWhen.
constexpr std::array when_texts{"a round at each exchange of particles", "rounds beside the work",
                                "a round at an exchange of particles where it is worth it"};

/// "rules, the picture (outputs.slice)", or nothing.
std::string who_asks(const Scene& scene, bool rules) {
  std::string out;
  const auto add = [&out](bool asks, const char* who) {
    if (asks) out += (out.empty() ? "" : ", ") + std::string(who);
  };
  add(rules, "rules");
  add(scene.outputs.slice.has_value(), "the picture (outputs.slice)");
  add(scene.outputs.fields, "the files (outputs.fields)");
  return out;
}

/// Which fields are built, what they hold, and for whom.
std::string explanation_of_fields(const Scene& scene, const Options& options) {
  std::string out;
  const auto line = [&out](const char* name, const std::string& used_by) {
    out += used_by.empty() ? fmt::format("  {}: left out\n", name)
                           : fmt::format("  {}: used, by {}\n", name, used_by);
  };
  const bool any = !scene.objects.empty(), asked = any && needs_field(scene.rules);
  line("distances", who_asks(scene, asked));
  line("normals", who_asks(scene, asked && needed_content(scene.rules) ==
                                               tess::dn::Content::distance_and_normal));
  if (any && builds_fields(scene)) {
    const auto n_read =
        std::count_if(scene.objects.begin(), scene.objects.end(),
                      [](const SceneObject& object) { return !object.field.empty(); });
    out += fmt::format("  fields: {} built, {} read from files\n",
                       scene.objects.size() - static_cast<std::size_t>(n_read), n_read);
    out += scene.compression ? fmt::format("  compression: used, within {} cells and {} degrees\n",
                                           scene.compression->cells, scene.compression->degrees)
                             : "  compression: left out, flat fields\n";
    if (!scene.compression && !options.json.empty())
      out += "  compressed copies: made after the run, for their size in the --json file\n";
  } else if (any) {
    out += "  fields: left out, no rule asks for a surface and no picture shows one\n";
  }
  const auto n_sheets = std::ranges::count_if(scene.objects, [&](const SceneObject& object) {
    return object.sides == tess::dn::Sides::two && keeps_triangles(scene, object);
  });
  out += n_sheets == 0
             ? "  triangles beside the fields: left out, no impacts on sheets\n"
             : fmt::format("  triangles beside the fields: used, of {} sheets\n", n_sheets);
  if (options.study) out += "  study: builds fields of its own, of the first object\n";
  return out;
}

}  // namespace

std::string explanation(const Scene& scene, const Options& options) {
  std::string out = "this scene, rule by rule\n";
  for (const std::string& rule : tess::dn::explain(scene.rules)) out += "  " + rule + "\n";
  out += explanation_of_fields(scene, options);
  const auto count = [&scene](bool (tess::dn::Frame::*holds)() const) {
    return std::count_if(scene.objects.begin(), scene.objects.end(),
                         [holds](const SceneObject& object) { return (object.frame.*holds)(); });
  };
  out += fmt::format("  objects: {}, of which {} move, {} of these grow\n", scene.objects.size(),
                     count(&tess::dn::Frame::is_moving), count(&tess::dn::Frame::is_growing));
  const std::size_t n_species = masses_of(scene).size();
  out += fmt::format("  step loops: {}, one for each mass\n", n_species);
  const std::uint64_t audited = n_audited(scene);
  out += audited == 0
             ? "  audit of each step for particles that tunnel: left out (outputs.audit)\n"
             : fmt::format(
                   "  audit of each step for particles that tunnel: used, of {} of {} particles; "
                   "their steps take 4 to 10 times as long\n",
                   audited, scene.n_particles());
  const auto& balance = options.run.balance;
  out += balance ? fmt::format("  balancer: used, {}, {}\n", balance->strategy,
                               when_texts[static_cast<std::size_t>(balance->when)])
                 : "  balancer: left out, blocks stay and no load is measured\n";
  if (scene.outputs.trajectories == 0) out += "  trajectories: left out\n";
  return out;
}

}  // namespace particles
