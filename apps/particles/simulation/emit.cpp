#include "apps/particles/simulation/emit.hpp"

#include "collide/dn_field/surface.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <numbers>

namespace particles {
namespace {
using tess::dn::Bounds;
using tess::dn::Vec3;

/// The random numbers of one particle, from the seed and its number.
class Numbers {
 public:
  Numbers(std::uint64_t seed, std::uint64_t number)
      : random_(tess::mix(tess::mix(seed) + number)) {}
  double unit() { return random_.unit(); }
  double between(double low, double high) { return low + (high - low) * unit(); }
  Vec3 between(Vec3 low, Vec3 high) {
    const double x = between(low.x, high.x), y = between(low.y, high.y);
    return {x, y, between(low.z, high.z)};
  }
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

}  // namespace

Source::Source(const Scene& scene) : scene_(scene), first_{0}, areas_(scene.objects.size()) {
  for (const Emitter& emitter : scene.emitters) {
    first_.push_back(first_.back() + emitter.count);
    if (emitter.where == Emitter::Where::surface && areas_[emitter.object].empty())
      areas_[emitter.object] = tess::dn::area_sums(scene.objects[emitter.object].surface);
  }
}

Start Source::particle(std::uint64_t id) const {
  const auto after = std::ranges::upper_bound(first_, id);
  const auto which = static_cast<std::size_t>(after - first_.begin()) - 1;
  const Emitter& emitter = scene_.emitters[which];
  const Vec3 low = emitter.low, high = emitter.high;
  const std::uint64_t number = id - first_[which];
  Numbers random(emitter.seed, number);
  Start start{{}, emitter.velocity, emitter.mass};
  switch (emitter.where) {
    case Emitter::Where::box:
      start.position = random.between(low, high);
      break;
    case Emitter::Where::lattice: {
      const auto [nx, ny, nz] = emitter.lattice;
      start.position = {lattice_at(low.x, high.x, number % nx, nx),
                        lattice_at(low.y, high.y, number / nx % ny, ny),
                        lattice_at(low.z, high.z, number / nx / ny, nz)};
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
    case Emitter::Where::surface: {
      const SceneObject& object = scene_.objects[emitter.object];
      const double first = random.unit(), second = random.unit(), third = random.unit();
      const auto [on, normal, triangle] =
          tess::dn::point_on(object.surface, areas_[emitter.object], first, second, third);
      const Vec3 out = object.frame.rotate(normal);
      start.position =
          object.frame.to_world(on) + random.between(emitter.inner, emitter.outer) * out;
      start.velocity = emitter.velocity + emitter.outward * out;
      break;
    }
  }
  const double spread = emitter.spread;
  if (spread != 0)
    start.velocity += random.between({-spread, -spread, -spread}, {spread, spread, spread});
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
      each_corner(object.surface, [&](Vec3 p) {
        box.extend(object.frame.to_world(p) - r);
        box.extend(object.frame.to_world(p) + r);
      });
    } else {
      box.extend(emitter.low);
      box.extend(emitter.high);
    }
  }
  return box;
}

}  // namespace particles
