#include "apps/particles/observe.hpp"

#include "apps/particles/fields.hpp"
#include "apps/particles/passage.hpp"
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

/// How an object stands in a step, from its begin to its end: often enough that a straight way in
/// the world is one between them, too, as the object sees it.
std::vector<tess::dn::Frame> frames_in(const tess::dn::Frame& begin, double step) {
  constexpr double angle = 0.05;  // off by 3e-4 of the distance from its origin
  const double pieces = norm(begin.angular_velocity) * step / angle;
  const int n = 1 + static_cast<int>(std::min(pieces, 1000.0));
  std::vector<tess::dn::Frame> frames{begin};
  for (int i = 1; i <= n; ++i) {
    frames.push_back(begin);
    frames.back().advance(step * i / n);
  }
  return frames;
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
                    Flock& flock) {
  for (std::size_t o = 0; o < at_begin.size(); ++o) {
    const auto& tree = stage.triangles[o];
    const tess::dn::Bvh* const triangles = tree ? &*tree : nullptr;
    const std::vector<tess::dn::Frame> frames = frames_in(at_begin[o].frame, stage.scene.dt);
    const double part = 1 / static_cast<double>(frames.size() - 1);
    for (std::size_t p = 0; p < flock.size(); ++p) {
      const Vec3 begin = before.position(p), way = flock.motion.position(p) - begin;
      Vec3 from = frames[0].to_object(begin);
      for (std::size_t i = 1; i < frames.size() && flock.marks[p].what != Mark::through; ++i) {
        const Vec3 to = frames[i].to_object(begin + static_cast<double>(i) * part * way);
        flock.marks[p] = mark_after(
            flock.marks[p], static_cast<std::uint16_t>(o), at_begin[o], triangles, from, to);
        from = to;
      }
    }
  }
}

void note_inside(const Stage& stage, const std::vector<Object>& objects, Flock& flock) {
  for (std::size_t o = 0; o < objects.size(); ++o) {
    const tess::dn::Field& field = *objects[o].field;
    if (field.sides == tess::dn::Sides::two) continue;
    for (std::size_t p = 0; p < flock.size(); ++p) {
      const Vec3 now = objects[o].frame.to_object(flock.motion.position(p));
      if (!(distance_at(objects[o], now) < -field.grid.cell)) continue;
      const Vec3 start =
          stage.scene.objects[o].frame.to_object(stage.source.particle(flock.ids[p]).position);
      if (!(distance_at(objects[o], start) < -field.grid.cell))
        flock.marks[p] = {Mark::through, 0, static_cast<std::uint16_t>(o)};
    }
  }
}

}  // namespace particles
