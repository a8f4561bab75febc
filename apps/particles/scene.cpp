#include "apps/particles/scene.hpp"

#include "collide/dn_field/walls.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>

namespace particles {

std::uint64_t Scene::n_particles() const {
  std::uint64_t n = 0;
  for (const Emitter& emitter : emitters) n += emitter.count;
  return n;
}

tess::dn::Rules for_mass(tess::dn::Rules rules, double mass) {
  if (mass == 1) return rules;
  if (rules.spring) {
    rules.spring->stiffness /= mass;
    rules.spring->damping /= mass;
  }
  if (rules.surface_drag) rules.surface_drag->rate /= mass;
  if (rules.surface_flow) {
    rules.surface_flow->alpha_in /= mass;
    rules.surface_flow->alpha_out /= mass;
  }
  if (rules.wind) rules.wind->rate /= mass;
  if (rules.air_drag) rules.air_drag->rate /= mass;
  for (tess::dn::Explosion& explosion : rules.explosions) explosion.strength /= mass;
  return rules;
}

void compress_fields(Scene& scene) {
  if (!scene.compression) scene.compression.emplace();
  if (scene.outputs.fields)
    tess::fail(tess::ErrorCode::bad_value,
               scene.name,
               ": outputs.fields: true, and the fields are compressed; files hold what was built, "
               "leave out one of the two");
  if (needs_field(scene.rules) && scene.rules.look_up == tess::dn::LookUp::trilinear)
    tess::fail(
        tess::ErrorCode::bad_value,
        scene.name,
        ": rules.look_up: trilinear cannot ask compressed fields; choose nearest or tangent, "
        "or leave out the compression");
}

double thin_share(const Scene& scene, const SceneObject& object) {
  if (!scene.rules.impact || object.sides == tess::dn::Sides::two) return 0;
  return share_thinner(object.walls, least_wall(scene.rules, object));
}

double kept_off(const tess::dn::Rules& rules, const SceneObject& object) {
  return rules.impact ? 2 * rules.impact->threshold / object.frame.scale : 0;
}

double least_wall(const tess::dn::Rules& rules, const SceneObject& object) {
  const double diagonals = rules.look_up == tess::dn::LookUp::nearest ? 1.5 : 1;
  return diagonals * std::sqrt(3.0) * object.grid.cell - kept_off(rules, object);
}

std::string field_file_name(std::size_t object) {
  return tess::text("field_", object, ".dnf");
}

std::vector<double> species_of(const Scene& scene) {
  std::vector<double> masses;
  for (const Emitter& emitter : scene.emitters)
    if (std::find(masses.begin(), masses.end(), emitter.mass) == masses.end())
      masses.push_back(emitter.mass);
  return masses;
}

}  // namespace particles
