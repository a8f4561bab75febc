#include "apps/bench/dn_field/dn_scene.hpp"

#include "collide/dn_field/shapes.hpp"

#include <algorithm>
#include <random>

namespace bench {

using namespace tess::dn;

Surface cut_box(int n) {
  const Surface box = make_box({half, half, half});
  Surface cut;
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto [a, b, c] = box.corners(t);
    const auto at = [&, from = a, u = b - a, v = c - a](int i, int j) {
      cut.vertices.push_back(from + (1.0 * i / n) * u + (1.0 * j / n) * v);
      return static_cast<std::uint32_t>(cut.vertices.size() - 1);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const auto p = at(i, j), q = at(i + 1, j), r = at(i, j + 1);
        cut.triangles.push_back({p, q, r});
        if (i + j + 1 < n) cut.triangles.push_back({q, at(i + 1, j + 1), r});
      }
  }
  return welded(cut);
}

double box_distance(Vec3 p) {
  const Vec3 q{std::abs(p.x) - half, std::abs(p.y) - half, std::abs(p.z) - half};
  const Vec3 outside{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return norm(outside) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

Particles placed(std::size_t count, double furthest) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  const double reach = std::min(0.95, half + furthest);
  Particles particles;
  while (particles.size() < count) {
    const Vec3 x = reach * Vec3{anywhere(random), anywhere(random), anywhere(random)};
    const double distance = box_distance(x);
    if (distance > 1e-3 && distance < furthest)
      particles.push_back(x, 0.5 * Vec3{anywhere(random), anywhere(random), anywhere(random)});
  }
  return particles;
}

double deepest(const Particles& particles) {
  double depth = 0;
  for (std::size_t p = 0; p < particles.size(); ++p)
    depth = std::max(depth, -box_distance(particles.position(p)));
  return depth;
}

}  // namespace bench
