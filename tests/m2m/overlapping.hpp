// A serial broad phase for tests of numerics without the runtime.
#pragma once

#include "m2m/conservative/loads.hpp"
#include "m2m/mesh.hpp"
#include "m2m/weights/point_rows.hpp"

#include <span>
#include <vector>

namespace tess::test {

inline m2m::MeshView view(const m2m::TetMesh& mesh) {
  return {mesh.points, mesh.tets};
}

/// All pairs of tetrahedra with boxes that overlap or touch, by target, then by source.
[[nodiscard]] std::vector<m2m::TetPair> overlapping_pairs(m2m::MeshView source,
                                                          m2m::MeshView target);

/// The best candidate for each point; tetrahedron -1 if none holds it.
[[nodiscard]] std::vector<m2m::PointInTet> place_points(m2m::MeshView source,
                                                        std::span<const m2m::Point> points);

}  // namespace tess::test
