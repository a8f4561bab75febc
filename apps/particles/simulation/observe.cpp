#include "apps/particles/simulation/observe.hpp"

#include "apps/particles/audit/passage.hpp"
#include "collide/dn_field/path.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <bit>

namespace particles {
namespace {
using tess::dn::Object;
using tess::dn::Vec3;

std::uint64_t hash_of(std::uint64_t id, Vec3 position, Vec3 velocity) {
  std::uint64_t hash = tess::mix(id);
  for (const double value :
       {position.x, position.y, position.z, velocity.x, velocity.y, velocity.z})
    hash = tess::mix(hash ^ std::bit_cast<std::uint64_t>(value));
  return hash;
}

/// The least signed distance to an object that reaches here; HUGE_VAL where none does.
double least_distance(const std::vector<Object>& objects, Vec3 p) {
  double least = HUGE_VAL;
  for (const Object& object : objects)
    least = std::min(least, object.frame.scale * distance_at(object, object.frame.to_object(p)));
  return least;
}

}  // namespace

void measure(const Stage& stage, const std::vector<Object>& objects, const Flock& flock,
             double mass, Measured& into) {
  const auto& gravity = stage.scene.rules.gravity;
  const Vec3 down = gravity ? gravity->acceleration : Vec3{};
  for (std::size_t p = 0; p < flock.size(); ++p) {
    const Vec3 position = flock.motion.position(p), velocity = flock.motion.velocity(p);
    ++into.particles;
    into.tunnelled += flock.tunnelled[p];
    into.hash += hash_of(flock.ids[p], position, velocity);
    if (!is_finite(position) || !is_finite(velocity)) {
      ++into.nonfinite;
      continue;
    }
    const double distance = least_distance(objects, position);
    into.inside += static_cast<std::uint64_t>(distance < 0);
    into.nearest = std::min(into.nearest, distance);
    into.fastest = std::max(into.fastest, norm(velocity));
    into.kinetic.add(0.5 * mass * dot(velocity, velocity));
    into.potential.add(-mass * dot(down, position));
  }
}

void trace(const Stage& stage, const Flock& flock, std::vector<Sample>& into) {
  const std::uint64_t n = stage.source.size(), traced = stage.scene.outputs.traced;
  for (std::size_t p = 0; p < flock.size(); ++p)
    if (is_sampled(flock.ids[p], n, traced))
      into.push_back({flock.ids[p], flock.motion.position(p), flock.motion.velocity(p)});
}

void note_tunnelled(const Stage& stage, const std::vector<Object>& at_begin,
                    const tess::dn::Particles& before,
                    std::span<const tess::dn::Waypoint> waypoints, Flock& flock) {
  const double depth = greatest_depth(stage.scene.rules);
  std::vector<tess::dn::PathSegment> segments;
  for (std::size_t o = 0; o < at_begin.size(); ++o) {
    const Audited audited{at_begin[o], stage.triangles[o] ? &*stage.triangles[o] : nullptr, depth};
    const auto passes = [&](Vec3 from, Vec3 to) { return leads_through(audited, from, to); };
    for (std::size_t p = 0; p < flock.size(); ++p) {
      if (flock.tunnelled[p] != 0) continue;
      path_segments(p, before.position(p), waypoints, flock.motion.position(p), segments);
      for (const tess::dn::PathSegment& segment : segments)
        if (any_piece(at_begin[o], stage.scene.dt, segment, passes)) flock.tunnelled[p] = 1;
    }
  }
}

void note_inside(const Stage& stage, const std::vector<Object>& objects, Flock& flock) {
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const tess::dn::Field& field = *objects[o].field;
    if (field.sides == tess::dn::Sides::two) continue;
    const double deepest = -greatest_depth(stage.scene.rules) * field.grid.cell;
    for (std::size_t p = 0; p < flock.size(); ++p) {
      const Vec3 now = objects[o].frame.to_object(flock.motion.position(p));
      if (!(distance_at(objects[o], now) < deepest)) continue;
      const Vec3 start =
          stage.scene.objects[o].frame.to_object(stage.source.particle(flock.ids[p]).position);
      if (!(distance_at(objects[o], start) < deepest)) flock.tunnelled[p] = 1;
    }
  }
}

}  // namespace particles
