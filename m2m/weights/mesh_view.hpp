// A mesh, or one part of it, as the numerics of transfers see it: points and tetrahedra that belong
// to the caller.
#pragma once

#include "m2m/mesh.hpp"

#include <span>

namespace tess::m2m {

/// Positions in `points` are the local ids of vertices, positions in `tets` those of tetrahedra.
struct MeshView {
  std::span<const Point> points;
  std::span<const Tet> tets;
};

}  // namespace tess::m2m
