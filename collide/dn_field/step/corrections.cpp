#include "collide/dn_field/step/corrections.hpp"

#include "collide/dn_field/bvh.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

using namespace lanes;

constexpr double noise = 1e-6;  // of the energy: the rounding of float distances

void erase_waypoints(const CorrectedStep& step, std::size_t p, L which) {
  std::erase_if(step.scratch.waypoints, [&](const Waypoint& bend) {
    return bend.particle - p < width && which[bend.particle - p] != 0;
  });
}

}  // namespace

bool limit_springs(const CorrectedStep& step, const NearestSurface& nearest_after) {
  const SpringConstants spring = step.constants.spring;  // copies that no store can change
  const ParticleSpan particles = step.particles;
  bool returned = false;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D depth = spring.reach - to_double(load<F>(nearest_after.distance + p));
    D3 u{};
    if (step.setting == Setting::general) u = surface_velocities(step.nearest, p);
    const D3 v = velocities(particles, p), w = v - u;
    const D kinetic = dot(w, w), had = max(load<D>(step.scratch.energy + p), D{}),
            left = had - spring.stiffness * depth * depth;
    const L over = (depth > 0.0) & (kinetic - left > noise * had) & (kinetic < HUGE_VAL);
    if (!any(over)) continue;
    const L slows = over & (left > 0.0), returns = over & ~slows;
    set_velocities(particles, p, select(slows, u + sqrt(only(slows, left / kinetic)) * w, v));
    if (!any(returns)) continue;
    returned = true;
    const D3 back = fma(all(step.constants.step), u, places(step.start, p)),
             turned = u + (u - velocities(step.start, p));
    set_places(particles, p, select(returns, back, places(particles, p)));
    set_velocities(particles, p, select(returns, turned, velocities(particles, p)));
    erase_waypoints(step, p, returns);
  }
  return returned;
}

bool keep_off_open_surfaces(const CorrectedStep& step, bool springs,
                            std::span<const PlacedObject> before,
                            std::span<const PlacedObject> after) {
  const ParticleSpan particles = step.particles;
  const bool may_fly_on = !springs && std::ranges::all_of(before, &PlacedObject::open_surface);
  const double dt = step.constants.step;
  const Vec3 gain = dt * step.constants.acceleration;
  std::vector<Crossing> crossings;
  const auto crossed = [&](Vec3 from, Vec3 to) -> const PlacedObject* {
    for (std::size_t o = 0; o < before.size(); ++o) {
      if (before[o].open_surface == nullptr) continue;
      crossings.clear();
      before[o].open_surface->crossings(before[o].frame.to_object(from),
                                        after[o].frame.to_object(to), crossings);
      if (!crossings.empty()) return &before[o];
    }
    return nullptr;
  };
  bool returned = false;
  for (std::size_t p = 0; p < particles.count; p += width) {
    D3 x = places(particles, p), v = velocities(particles, p);
    const D3 x0 = places(step.start, p), v0 = velocities(step.start, p);
    L may = ~L{};
    if (step.sweep == Sweep::on) {
      D3 way = x - x0;
      if (step.setting == Setting::general)
        way = fma(all(-step.constants.step), surface_velocities(step.nearest, p), way);
      const D free = max(to_double(load<F>(step.nearest.free + p)), D{});
      may = ~(dot(way, way) <= free * free);
    }
    L returns{};
    for (int i = 0; i < width; ++i) {
      if (may[i] == 0) continue;
      const auto at = [i](const D3& of) { return Vec3{of.x[i], of.y[i], of.z[i]}; };
      const Vec3 from = at(x0), velocity = at(v0);
      const PlacedObject* const object = is_finite(at(x)) ? crossed(from, at(x)) : nullptr;
      if (object == nullptr) continue;
      Vec3 to = from + dt * (velocity + 0.5 * gain), velocity_to = velocity + gain;
      if (!may_fly_on || crossed(from, to) != nullptr) {
        const Frame &first = object->frame,
                    &last = after[static_cast<std::size_t>(object - before.data())].frame;
        to = last.to_world(first.to_object(from));
        velocity_to = last.velocity_at(to) + first.velocity_at(from) - velocity;
      }
      x.x[i] = to.x, x.y[i] = to.y, x.z[i] = to.z;
      v.x[i] = velocity_to.x, v.y[i] = velocity_to.y, v.z[i] = velocity_to.z;
      returns[i] = -1;
    }
    if (!any(returns)) continue;
    returned = true;
    set_places(particles, p, x), set_velocities(particles, p, v);
    erase_waypoints(step, p, returns);
  }
  return returned;
}

}  // namespace tess::dn
