// Bodies of unit cubes, of which the answer is known: non-convex, with cavities, and with edges and
// corners where they touch themselves.
#pragma once

#include "m2m/overset.hpp"

#include <array>
#include <random>
#include <vector>

namespace tess::test {

struct VoxelBody {
  static constexpr int n = 4;  // cubes on an edge
  std::array<bool, n * n * n> filled{};

  VoxelBody(std::mt19937& random, double share) {
    for (bool& cube : filled) cube = std::uniform_real_distribution<>()(random) < share;
  }
  [[nodiscard]] bool at(int x, int y, int z) const {
    for (const int i : {x, y, z})
      if (i < 0 || i >= n) return false;
    return filled[static_cast<std::size_t>((x * n + y) * n + z)];
  }
  /// Of the point (x, y, z) / 2: by the cubes that touch it.
  [[nodiscard]] m2m::Containment answer(std::array<int, 3> twice) const {
    bool all = true, any = false;
    const auto cubes = [](int t) {
      return t % 2 == 0 ? std::array{t / 2 - 1, t / 2} : std::array{(t - 1) / 2, (t - 1) / 2};
    };
    for (const int x : cubes(twice[0] + 2 * n))
      for (const int y : cubes(twice[1] + 2 * n))
        for (const int z : cubes(twice[2] + 2 * n)) {
          const bool is_filled = at(x - n, y - n, z - n);
          all = all && is_filled;
          any = any || is_filled;
        }
    if (all) return m2m::Containment::inside;
    return any ? m2m::Containment::on_wall : m2m::Containment::outside;
  }
};

/// Two triangles for each side between a filled cube and an empty one. A random bit chooses the
/// diagonal; `place` maps corners.
struct VoxelSurface {
  std::vector<m2m::Point> points;
  std::vector<std::array<m2m::VertexId, 3>> triangles;

  template <class Place>
  VoxelSurface(const VoxelBody& body, std::mt19937& random, const Place& place) {
    for (int x = 0; x < VoxelBody::n; ++x)
      for (int y = 0; y < VoxelBody::n; ++y)
        for (int z = 0; z < VoxelBody::n; ++z)
          for (std::size_t axis = 0; axis < 3; ++axis)
            for (const int way : {-1, 1}) {
              std::array<int, 3> cube{x, y, z}, next = cube;
              next[axis] += way;
              if (!body.at(x, y, z) || body.at(next[0], next[1], next[2])) continue;
              std::array<m2m::VertexId, 4> quad{};
              constexpr std::array<std::array<int, 2>, 4> around{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
              for (std::size_t i = 0; i < 4; ++i) {
                std::array<int, 3> corner = cube;
                corner[axis] += way > 0 ? 1 : 0;
                corner[(axis + 1) % 3] += around[i][0];
                corner[(axis + 2) % 3] += around[i][1];
                quad[way > 0 ? i : 3 - i] = static_cast<m2m::VertexId>(points.size());
                points.push_back(place(corner[0], corner[1], corner[2]));
              }
              const std::size_t first = random() % 2;
              const auto q = [&](std::size_t i) { return quad[(first + i) % 4]; };
              triangles.push_back({q(0), q(1), q(2)});
              triangles.push_back({q(0), q(2), q(3)});
            }
  }
};

}  // namespace tess::test
