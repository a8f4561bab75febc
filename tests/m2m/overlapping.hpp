// A serial broad phase for tests of numerics without the runtime.
#pragma once

#include "m2m/conservative/overlaps.hpp"
#include "m2m/mesh.hpp"
#include "m2m/weights/point_rows.hpp"

#include <span>
#include <vector>

namespace tess::test {

inline m2m::MeshView view(const m2m::TetMesh& mesh) {
  return {mesh.points, mesh.tets};
}

/// A source and a target tetrahedron, as positions in two MeshViews.
struct TetPair {
  std::int32_t source;
  std::int32_t target;
};

/// All pairs of tetrahedra with boxes that overlap or touch, by target, then by source.
[[nodiscard]] std::vector<TetPair> overlapping_pairs(m2m::MeshView source, m2m::MeshView target);

/// The overlaps of two meshes, whose ids are positions.
[[nodiscard]] m2m::Overlaps overlaps_of(const m2m::TetMesh& source, const m2m::TetMesh& target);

/// The loads of a source field, row-major: four rows per target tetrahedron.
[[nodiscard]] std::vector<double> loads_of(const m2m::Overlaps& overlaps,
                                           const m2m::TetMesh& source, const m2m::TetMesh& target,
                                           const m2m::SourceField& field);

/// The best candidate for each point; tetrahedron -1 if none holds it.
[[nodiscard]] std::vector<m2m::PointInTet> place_points(m2m::MeshView source,
                                                        std::span<const m2m::Point> points);

}  // namespace tess::test
