// Triangulated walls for tests of couplings on surfaces.
#pragma once

#include "m2m/mesh.hpp"

#include <cmath>
#include <numbers>

namespace tess::test {

enum class Wall : std::uint8_t {
  plane,   ///< tilted: z = 0.3 x + 0.2 y, x and y from 0 to 1; 2 n² triangles
  sphere,  ///< of radius 1 about the origin, with poles on the z axis; about 12 n² triangles
  torus,   ///< of the radii 1 and 0.4 about the z axis; 12 n² triangles
};

/// The normals of a sphere and a torus point outward. `turn`: by what angle the grid of a torus is
/// turned along both circles, and that of a sphere about the z axis.
inline m2m::TetMesh wall_mesh(Wall wall, int n, double turn = 0) {
  const bool is_plane = wall == Wall::plane, is_torus = wall == Wall::torus;
  const int nu = is_plane ? n : 3 * n, nv = is_plane ? n : 2 * n;
  m2m::TetMesh mesh;
  mesh.dimension = 2;
  for (int j = 0; j < (is_torus ? nv : nv + 1); ++j)
    for (int i = 0; i < (is_plane ? nu + 1 : nu); ++i) {
      const double s = static_cast<double>(i) / nu, t = static_cast<double>(j) / nv;
      const double u = turn + 2 * std::numbers::pi * s;
      const double v = is_torus ? turn + 2 * std::numbers::pi * t : std::numbers::pi * (t - 0.5);
      const double r = is_torus ? 1 + 0.4 * std::cos(v) : j == 0 || j == nv ? 0 : std::cos(v);
      if (is_plane)
        mesh.points.push_back({s, t, 0.3 * s + 0.2 * t});
      else
        mesh.points.push_back(
            {r * std::cos(u), r * std::sin(u), (is_torus ? 0.4 : 1) * std::sin(v)});
    }
  const auto at = [&](int i, int j) {
    return is_plane ? j * (nu + 1) + i : (is_torus ? j % nv : j) * nu + i % nu;
  };
  const auto add = [&](int a, int b, int c) {  // all but those without area, at the poles
    const auto place = [&](int v) { return mesh.points[static_cast<std::size_t>(v)]; };
    if (place(a) != place(b) && place(b) != place(c)) mesh.tets.push_back({a, b, c, c});
  };
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return mesh;
}

/// n edges on a circle of radius 1 in the plane z = 0.
inline m2m::TetMesh circle_mesh(int n, double turn = 0) {
  m2m::TetMesh mesh;
  mesh.dimension = 1;
  for (int i = 0; i < n; ++i) {
    const double u = turn + 2 * std::numbers::pi * i / n;
    mesh.points.push_back({std::cos(u), std::sin(u), 0});
    mesh.tets.push_back({i, (i + 1) % n, (i + 1) % n, (i + 1) % n});
  }
  return mesh;
}

}  // namespace tess::test
