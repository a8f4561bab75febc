#include "apps/particles/scene/scene.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace particles {

std::uint64_t Scene::n_particles() const {
  std::uint64_t n = 0;
  for (const Emitter& emitter : emitters) n += emitter.count;
  return n;
}

tess::dn::Rules for_mass(tess::dn::Rules rules, double mass) {
  if (auto& spring = rules.spring) spring->stiffness /= mass, spring->damping /= mass;
  if (auto& drag = rules.surface_drag) drag->rate /= mass;
  if (auto& flow = rules.surface_flow) flow->alpha_in /= mass, flow->alpha_out /= mass;
  if (auto& wind = rules.wind) wind->rate /= mass;
  if (auto& drag = rules.air_drag) drag->rate /= mass;
  for (tess::dn::Explosion& explosion : rules.explosions) explosion.strength /= mass;
  return rules;
}

void compress_fields(Scene& scene) {
  if (!scene.compression) scene.compression.emplace();
  if (scene.outputs.fields)
    tess::fail(tess::ErrorCode::bad_value, scene.name,
               ": outputs.fields: true, and the fields are compressed; files hold what was built, "
               "leave out one of the two");
  if (needs_field(scene.rules) && scene.rules.look_up == tess::dn::LookUp::trilinear)
    tess::fail(
        tess::ErrorCode::bad_value, scene.name,
        ": rules.look_up: trilinear does not support compressed fields; choose nearest or tangent, "
        "or leave out the compression");
}

double least_scale(const Scene& scene, const SceneObject& object) {
  return object.frame.scale + std::min(0.0, object.frame.scale_rate) * scene.dt * scene.steps;
}

double greatest_scale(const Scene& scene, const SceneObject& object) {
  return object.frame.scale + std::max(0.0, object.frame.scale_rate) * scene.dt * scene.steps;
}

bool builds_fields(const Scene& scene) {
  return needs_field(scene.rules) || scene.outputs.slice || scene.outputs.fields;
}

double least_wall(const tess::dn::Rules& rules, const SceneObject& object) {
  const double diagonals = rules.look_up == tess::dn::LookUp::nearest ? 3 : 1;
  return diagonals * std::sqrt(3.0) * object.grid.cell;
}

std::uint64_t n_audited(const Scene& scene) {
  return needs_field(scene.rules) ? std::min(scene.outputs.audited, scene.n_particles()) : 0;
}

std::vector<double> masses_of(const Scene& scene) {
  std::vector<double> masses;
  for (const Emitter& emitter : scene.emitters)
    if (std::ranges::find(masses, emitter.mass) == masses.end()) masses.push_back(emitter.mass);
  return masses;
}

}  // namespace particles
