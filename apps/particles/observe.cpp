#include "apps/particles/observe.hpp"

#include "apps/particles/fields.hpp"
#include "apps/particles/passage.hpp"
#include "collide/dn_field/leg.hpp"
#include "runtime/base/mix.hpp"

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

/// Calls visit(leg) for the straight parts of each particle's way through a step, in the order of
/// particles and time. visit: void(std::size_t particle, const Leg&).
template <class Visit>
void for_each_leg(const tess::dn::Particles& before,
                  std::span<const tess::dn::Waypoint> waypoints,
                  const tess::dn::Particles& after,
                  const Visit& visit) {
  auto next = waypoints.begin();
  for (std::size_t p = 0; p < after.size(); ++p) {
    tess::dn::Leg leg{0, 1, before.position(p), {}};
    for (; next != waypoints.end() && next->particle == p; ++next) {
      leg.end = next->part, leg.to = next->place;
      visit(p, leg);
      leg.begin = leg.end, leg.from = leg.to;
    }
    leg.end = 1, leg.to = after.position(p);
    visit(p, leg);
  }
}

}  // namespace

void measure(const Stage& stage,
             const std::vector<Object>& objects,
             const Flock& flock,
             std::size_t species,
             Measured& into) {
  const double mass = stage.masses[species];
  const auto& gravity = stage.scene.rules.gravity;
  const Vec3 down = gravity ? gravity->acceleration : Vec3{};
  for (std::size_t p = 0; p < flock.size(); ++p) {
    const Vec3 position = flock.motion.position(p), velocity = flock.motion.velocity(p);
    ++into.particles;
    into.tunnelled += static_cast<std::uint64_t>(flock.marks[p].what == Mark::through);
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

bool is_traced(std::uint64_t id, std::uint64_t n, std::uint64_t traced) {
  if (traced >= n) return true;
  return id * traced % n < traced;  // below 1e18: there are at most 1e9 particles
}

void trace(const Stage& stage, const Flock& flock, std::vector<Sample>& into) {
  const std::uint64_t n = stage.source.size(), traced = stage.scene.outputs.traced;
  for (std::size_t p = 0; p < flock.size(); ++p)
    if (is_traced(flock.ids[p], n, traced))
      into.push_back({flock.ids[p], flock.motion.position(p), flock.motion.velocity(p)});
}

void note_tunnelled(const Stage& stage,
                    const std::vector<Object>& at_begin,
                    const tess::dn::Particles& before,
                    std::span<const tess::dn::Waypoint> waypoints,
                    Flock& flock) {
  const double depth = greatest_depth(stage.scene.rules);
  for (std::size_t o = 0; o < at_begin.size(); ++o) {
    const auto& tree = stage.triangles[o];
    const Audited audited{
        static_cast<std::uint16_t>(o), at_begin[o], tree ? &*tree : nullptr, depth};
    for_each_leg(before, waypoints, flock.motion, [&](std::size_t p, const tess::dn::Leg& leg) {
      Mark& mark = flock.marks[p];
      if (mark.what == Mark::through) return;
      any_piece(at_begin[o].frame, stage.scene.dt, leg, [&](Vec3 from, Vec3 to) {
        mark = mark_after(mark, audited, from, to);
        return mark.what == Mark::through;
      });
    });
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
      if (!(distance_at(objects[o], start) < deepest))
        flock.marks[p] = {Mark::through, 0, static_cast<std::uint16_t>(o)};
    }
  }
}

}  // namespace particles
