// Many closed bodies that move through each other, in clusters of uneven density: work that shifts
// from place to place. The pose of a body is a function of its number and the step, so every PE and
// every run computes the same.
//
//     ⁖⁘⁙⁘ →   ∴ ⁖        Cluster c has a share of the bodies proportional to 2^-c, and all clusters
//     ⁙⁘⁖⁙      ↙    ·    have one radius. Each goes around a common centre, and its bodies around
//                         the centre of the cluster, the inner ones faster.
#include "apps/collide_scene/scenes/elementary.hpp"
#include "apps/collide_scene/scenes/kinds.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/core.h>
#include <memory>

namespace collide_scene {
namespace {

using tess::collide::Point;
using tess::collide::Triangle;

class Crowd {
 public:
  static constexpr std::uint64_t triangles_per_body = 128;

  Crowd(std::uint64_t n_bodies, std::uint64_t seed);

  [[nodiscard]] std::uint64_t n_bodies() const noexcept { return bodies_.size(); }
  /// The triangles of a body at a step, which may be fractional: the same mesh each time, moved as
  /// a rigid body. `out` has triangles_per_body places.
  void triangles(std::uint64_t body, double step, std::span<tess::collide::Triangle> out) const;

 private:
  struct Body {
    std::uint32_t cluster;
    double distance, height, phase;  // from the axis of the cluster, along it, in turns about it
    double spin, scale;              // turns per step about its own axis; size
  };
  [[nodiscard]] tess::collide::Point centre(const Body& body, double step) const noexcept;

  double cluster_radius_;
  std::vector<Body> bodies_;
  std::array<tess::collide::Triangle, triangles_per_body> mesh_;
};

constexpr std::uint32_t kClusters = 8;
constexpr double kTurnsPerStep = 1.0 / 1024;  // of the clusters about the common centre

/// A bumpy ball of about unit radius at the direction (i, j, k): equal integers, equal point.
Point on_ball(int i, int j, int k) {
  const double x = i, y = j, z = k;
  const double length = std::sqrt(x * x + y * y + z * z);
  const double radius =
      1 + 0.15 * sine((x + 2 * y) / 8) * cosine((z - x) / 8) + 0.1 * sine((y - 2 * z) / 8);
  return {radius * x / length, radius * y / length, radius * z / length};
}

/// The faces of an octahedron, each cut into 4 × 4 triangles.
std::array<Triangle, Crowd::triangles_per_body> ball() {
  std::array<Triangle, Crowd::triangles_per_body> mesh{};
  std::size_t next = 0;
  for (int face = 0; face < 8; ++face) {
    const int sx = face & 1 ? -1 : 1, sy = face & 2 ? -1 : 1, sz = face & 4 ? -1 : 1;
    const auto at = [&](int i, int j) { return on_ball(sx * i, sy * j, sz * (4 - i - j)); };
    // Corners turn the same way, seen from outside, on all faces.
    const auto add = [&](const Point& a, const Point& b, const Point& c) {
      mesh[next++] = sx * sy * sz > 0 ? Triangle{{a, b, c}} : Triangle{{a, c, b}};
    };
    for (int i = 0; i < 4; ++i)
      for (int j = 0; i + j < 4; ++j) {
        add(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j < 3) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }
  return mesh;
}

/// The cluster of a body: half of them in the first, a quarter in the second, and so on.
std::uint32_t cluster_of(std::uint64_t hash) {
  return std::min(static_cast<std::uint32_t>(std::countl_zero(hash)), kClusters - 1);
}

Crowd::Crowd(std::uint64_t n_bodies, std::uint64_t seed)
    : cluster_radius_(1.8 * cube_root(static_cast<double>(n_bodies))), mesh_(ball()) {
  tess::Random random(seed);
  bodies_.reserve(n_bodies);
  for (std::uint64_t b = 0; b < n_bodies; ++b) {
    Body body{};
    body.cluster = cluster_of(random());
    body.distance = cluster_radius_ * std::sqrt(random.unit());
    body.height = cluster_radius_ * (2 * random.unit() - 1);
    body.phase = random.unit();
    body.spin = (random.unit() - 0.5) / 64;
    body.scale = 0.5 + random.unit();
    bodies_.push_back(body);
  }
}

Point Crowd::centre(const Body& body, double step) const noexcept {
  const double path = body.cluster / static_cast<double>(kClusters) + kTurnsPerStep * step;
  const double turn =
      body.phase + step * kTurnsPerStep * 4 / (1 + 3 * body.distance / cluster_radius_);
  const double ring = 2.5 * cluster_radius_;
  return {ring * cosine(path) + body.distance * cosine(turn),
          ring * sine(path) + body.distance * sine(turn),
          body.height + 0.5 * cluster_radius_ * sine(2 * path + body.cluster / 3.0)};
}

void Crowd::triangles(std::uint64_t number, double step, std::span<Triangle> out) const {
  const Body& body = bodies_[number];
  const Point at = centre(body, step);
  const double turn = body.phase + body.spin * step;
  const double c = body.scale * cosine(turn), s = body.scale * sine(turn);
  for (std::size_t t = 0; t < mesh_.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Point& p = mesh_[t].corners[corner];
      out[t].corners[corner] = {at[0] + c * p[0] - s * p[1], at[1] + s * p[0] + c * p[1],
                                at[2] + body.scale * p[2]};
    }
}

}  // namespace

Scene crowd(std::uint64_t n, std::uint64_t seed) {
  constexpr std::uint64_t each = Crowd::triangles_per_body;
  const auto bodies = std::make_shared<const Crowd>(std::max<std::uint64_t>(1, n / each), seed);
  Scene scene;
  scene.description = fmt::format("{} moving bodies of {} triangles each in {} clusters",
                                  bodies->n_bodies(), each, kClusters);
  scene.triangles.resize(bodies->n_bodies() * each);
  for (std::uint64_t b = 0; b < bodies->n_bodies(); ++b)
    scene.models.insert(scene.models.end(), each, static_cast<std::uint32_t>(b));
  scene.move = [bodies](double step, Scene& moved) {
    for (std::uint64_t b = 0; b < bodies->n_bodies(); ++b)
      bodies->triangles(b, step, std::span(moved.triangles).subspan(b * each, each));
  };
  scene.move(0, scene);
  return scene;
}

}  // namespace collide_scene
