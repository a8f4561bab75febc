// The sides of cells: the triangles of a tetrahedron, the edges of a triangle, the ends of an edge.
// A side is written as TetMesh::tets writes a cell of one dimension less. The skin of a mesh, its
// side sets and the physical groups of gmsh are made of them.
#pragma once

#include "m2m/mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {

/// Side `side` of a cell, numbered from 1 on as Side says. The triangle of a tetrahedron that is not
/// inverted is counter-clockwise seen from outside.
[[nodiscard]] Tet side_of(const Tet& cell, std::int32_t dimension, std::int32_t side);

/// A side as a cell: a triangle of a tetrahedron faces away from it, also if that is inverted.
[[nodiscard]] Tet outward(const TetMesh& mesh, const Side& side);

/// Gives cells of this dimension the same key if they have the same corners.
[[nodiscard]] Tet key_of(Tet cell, std::int32_t dimension);

[[nodiscard]] inline bool names_corner_twice(const Tet& cell, std::int32_t dimension) {
  const Tet key = key_of(cell, dimension);
  return std::adjacent_find(key.begin(), key.begin() + dimension + 1) !=
         key.begin() + dimension + 1;
}

/// The sides that are sides of one of these cells only, in the order of the cells. `cells`: pairs of
/// the first and the end. Cells that name a corner twice have no sides.
[[nodiscard]] std::vector<Side> boundary_sides(
    const TetMesh& mesh, std::span<const std::pair<GlobalId, GlobalId>> cells);

/// Finds sides by their corners.
class SideFinder {
 public:
  /// Lists the sides all of whose corners are marked. `marks`: per point of the mesh.
  SideFinder(const TetMesh& mesh, const std::vector<bool>& marks);
  /// The side with the corners of `cell`, of the first cell that has it; cell -1 if there is none.
  [[nodiscard]] Side find(const Tet& cell) const;

 private:
  std::int32_t dimension_;                    // of the sides
  std::vector<std::pair<Tet, Side>> sorted_;  // by key, then by cell
};

}  // namespace tess::m2m
