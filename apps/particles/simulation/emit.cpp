#include "apps/particles/simulation/emit.hpp"

#include "collide/dn_field/surface.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <numbers>

namespace particles {
namespace {
using tess::dn::Bounds;
using tess::dn::Vec3;

/// The random numbers of one particle: the k-th is mixed from seed, number and k.
class Numbers {
 public:
  Numbers(std::uint64_t seed, std::uint64_t number)
      : random_(tess::mix(tess::mix(seed) + number)) {}
  double unit() { return random_.unit(); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  Vec3 direction() {  // uniform on the sphere (Archimedes)
    const double z = between(-1, 1), turn = 2 * std::numbers::pi * unit();
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(turn), r * std::sin(turn), z};
  }

 private:
  tess::Random random_;
};

double lattice_at(double low, double high, std::uint64_t i, std::uint64_t n) {
  return n == 1 ? 0.5 * (low + high)
                : low + (high - low) * (static_cast<double>(i) / static_cast<double>(n - 1));
}

void add_random_velocity(Start& start, double spread, Numbers& random) {
  if (spread == 0) return;
  const double x = random.between(-spread, spread), y = random.between(-spread, spread),
               z = random.between(-spread, spread);
  start.velocity += {x, y, z};
}

}  // namespace

Source::Source(const Scene& scene) : scene_(scene), first_{0}, areas_(scene.objects.size()) {
  for (const Emitter& emitter : scene.emitters) {
    first_.push_back(first_.back() + emitter.count);
    if (emitter.where == Emitter::Where::surface && areas_[emitter.object].empty())
      areas_[emitter.object] = tess::dn::area_sums(scene.objects[emitter.object].surface);
  }
}

Start Source::from_surface(const Emitter& emitter, std::uint64_t number) const {
  Numbers random(emitter.seed, number);
  const SceneObject& object = scene_.objects[emitter.object];
  const double first = random.unit(), second = random.unit(), third = random.unit();
  const auto [on, normal, triangle] =
      tess::dn::point_on(object.surface, areas_[emitter.object], first, second, third);
  const tess::dn::Frame& frame = object.frame;
  Start start;
  start.position =
      frame.to_world(on) + random.between(emitter.inner, emitter.outer) * frame.rotate(normal);
  start.velocity = emitter.velocity + emitter.outward * frame.rotate(normal);
  add_random_velocity(start, emitter.spread, random);
  return start;
}

Start Source::particle(std::uint64_t id) const {
  const auto after = std::upper_bound(first_.begin(), first_.end(), id);
  const auto which = static_cast<std::size_t>(after - first_.begin()) - 1;
  const Emitter& emitter = scene_.emitters[which];
  const std::uint64_t number = id - first_[which];
  Numbers random(emitter.seed, number);
  Start start;
  start.velocity = emitter.velocity;
  switch (emitter.where) {
    case Emitter::Where::box: {
      const double x = random.between(emitter.low.x, emitter.high.x),
                   y = random.between(emitter.low.y, emitter.high.y),
                   z = random.between(emitter.low.z, emitter.high.z);
      start.position = {x, y, z};
      break;
    }
    case Emitter::Where::lattice: {
      const auto [nx, ny, nz] = emitter.lattice;
      start.position = {lattice_at(emitter.low.x, emitter.high.x, number % nx, nx),
                        lattice_at(emitter.low.y, emitter.high.y, number / nx % ny, ny),
                        lattice_at(emitter.low.z, emitter.high.z, number / nx / ny, nz)};
      break;
    }
    case Emitter::Where::sphere: {
      const Vec3 towards = random.direction();
      const double inner = emitter.inner * emitter.inner * emitter.inner,
                   outer = emitter.outer * emitter.outer * emitter.outer;
      start.position = emitter.centre + std::cbrt(random.between(inner, outer)) * towards;
      start.velocity += emitter.outward * towards;
      break;
    }
    case Emitter::Where::surface:
      start = from_surface(emitter, number);
      break;
  }
  if (emitter.where != Emitter::Where::surface) add_random_velocity(start, emitter.spread, random);
  start.mass = emitter.mass;
  return start;
}

Bounds Source::bounds() const {
  Bounds box;
  for (const Emitter& emitter : scene_.emitters) {
    const double reach = std::max(std::abs(emitter.inner), std::abs(emitter.outer));
    const Vec3 r{reach, reach, reach};
    if (emitter.where == Emitter::Where::sphere) {
      box.extend(emitter.centre - r);
      box.extend(emitter.centre + r);
    } else if (emitter.where == Emitter::Where::surface) {
      const SceneObject& object = scene_.objects[emitter.object];
      for (const Vec3 p : object.surface.vertices) {
        box.extend(object.frame.to_world(p) - r);
        box.extend(object.frame.to_world(p) + r);
      }
    } else {
      box.extend(emitter.low);
      box.extend(emitter.high);
    }
  }
  return box;
}

}  // namespace particles
