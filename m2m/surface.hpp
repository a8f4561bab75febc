// The surface of a mesh, or a named part of it, as a mesh of its own: source or target of transfers
// like any other.
//
//     const TetMesh volume = read_mesh("flow.exo");
//     const SurfaceMesh wall = surface_of(volume, "wall");
//     const Field pressure = rows_of(at_vertices, wall.vertex_of_point);
//     write_vtu("wall.vtu", wall.mesh, std::array{pressure});
//
// | of a mesh of     | skin             | side set  | block                  |
// |------------------|------------------|-----------|------------------------|
// | tetrahedra       | triangles        | triangles | triangles, of its skin |
// | triangles        | edges            | edges     | its triangles          |
// | edges            | –                | –         | its edges              |
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace tess::m2m {

struct SurfaceMesh {
  /// Its points are those that its cells use, in the order of the volume; its cells are in the order
  /// of the volume's cells, or of the side set. Triangles of tetrahedra are counter-clockwise seen
  /// from outside of the (lower) tetrahedron, also if that is inverted. Its one block has the number
  /// and the name of the part.
  TetMesh mesh;
  std::vector<VertexId> vertex_of_point;  ///< in the volume; ascends
  std::vector<GlobalId> tet_of_cell;      ///< the volume's cell of which it is a side, or is
};

/// The sides that only one cell has. Throws Error (bad_argument) if there are none, as of a closed
/// surface.
[[nodiscard]] SurfaceMesh skin_of(const TetMesh& mesh);

/// A part by name: "skin", the name of a side set or of a block, the number of a side set or of a
/// block, or "block 3" for the block of that number. The first of these that exists is taken; sets or
/// blocks of one name are one part, and a side that is listed twice counts once. Throws Error
/// (bad_argument) that lists the parts if there is none of this name, or if it is empty.
[[nodiscard]] SurfaceMesh surface_of(const TetMesh& mesh, std::string_view part);

/// The values of a field at some of its rows: carries fields over to a surface, by vertex_of_point
/// those at vertices, by tet_of_cell those in cells.
template <class Id>
[[nodiscard]] Field rows_of(const Field& field, const std::vector<Id>& rows) {
  Field out{field.name, field.n_components, {}};
  out.values.reserve(rows.size() * field.n_components);
  for (const Id row : rows) {
    const auto first = field.values.begin() + static_cast<std::ptrdiff_t>(row) *
                                                  static_cast<std::ptrdiff_t>(field.n_components);
    out.values.insert(out.values.end(), first,
                      first + static_cast<std::ptrdiff_t>(field.n_components));
  }
  return out;
}

}  // namespace tess::m2m
