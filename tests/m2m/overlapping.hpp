// A serial broad phase for tests of numerics without the runtime.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/rows/conservative/overlap_rows.hpp"
#include "m2m/rows/weights/point_rows.hpp"

#include <array>
#include <span>
#include <vector>

namespace tess::test {

inline m2m::MeshView view(const m2m::TetMesh& mesh) {
  return {mesh.points, mesh.tets};
}

/// A source and a target tetrahedron, as positions in two MeshViews.
struct TetPair {
  std::int32_t source, target;
};

/// All pairs of tetrahedra with boxes that overlap or touch, by target, then by source.
[[nodiscard]] std::vector<TetPair> overlapping_pairs(m2m::MeshView source, m2m::MeshView target);

/// Rows from a source onto the points or cells of a target; ids are positions.
[[nodiscard]] m2m::OverlapRows rows_between(const m2m::TetMesh& source, m2m::Centring from,
                                            const m2m::TetMesh& target, m2m::Centring to);
/// The loads of the constant 1 for all tetrahedra of the target, of such rows.
[[nodiscard]] std::vector<std::array<double, 4>> covered_by(const m2m::OverlapRows& rows,
                                                            const m2m::TetMesh& target);

/// Values of kind native at points in the mesh, of values at its vertices, in one loop.
[[nodiscard]] std::vector<double> native_values(const m2m::TetMesh& mesh,
                                                std::span<const double> values,
                                                std::span<const m2m::Point> points,
                                                std::uint64_t& n_linear);

/// The best candidate for each point; tetrahedron -1 if none holds it.
[[nodiscard]] std::vector<m2m::PointInTet> place_points(m2m::MeshView source,
                                                        std::span<const m2m::Point> points);

}  // namespace tess::test
