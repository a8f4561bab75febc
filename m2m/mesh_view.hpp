// A mesh, or a part of it, as the owner of the data shows it: spans, so nothing is copied. A view
// is valid during the call that it is passed to. Positions in `points` and `tets` are local ids.
#pragma once

#include "m2m/mesh.hpp"
#include "runtime/core/algorithm.hpp"

#include <cstdint>
#include <span>

namespace tess::m2m {

struct MeshView {
  std::span<const Point> points{};  ///< those that this part owns first, then its ghosts
  std::span<const Tet> tets{};      ///< indices into points; empty for a cloud
  std::span<const GlobalId>
      point_ids{};                      ///< per point; unique in the mesh; ties are decided by them
  std::span<const GlobalId> tet_ids{};  ///< per tetrahedron; unique in the mesh
  /// The first n_owned points receive values. Those that are corners of tetrahedra here are
  /// vertices that a point outside may be nearest to: policy Nearest and kind nearest need it in a
  /// source, too.
  std::int64_t n_owned = 0;
  /// The first tetrahedra are the part's own. The others are a halo, for recovered gradients: they
  /// are also in other parts. -1: all are its own.
  std::int64_t n_own_tets = -1;
  std::int32_t dimension = 3;  ///< of its cells: TetMesh::dimension
  /// For kind native, as in NativeElements; -1 for a halo.
  std::span<const std::int64_t> element_of_tet{};
  std::span<const VertexId> element_vertices{};
  /// The tetrahedra were split from elements, which this part does not hold: kind native refuses it.
  bool lacks_elements = false;

  [[nodiscard]] std::span<const Point> owned() const {
    return points.first(static_cast<std::size_t>(n_owned));
  }
  [[nodiscard]] std::span<const Tet> own_tets() const {
    return n_own_tets < 0 ? tets : tets.first(static_cast<std::size_t>(n_own_tets));
  }
};

/// Throws Error (bad_mesh) with the first point, index or list that cannot be used: coordinates
/// must be finite and at most 1e100, corners in range, cells of the dimension, and ids as many as
/// points and cells.
void validate(const MeshView& mesh);

/// Throws Error (bad_mesh) with the first tetrahedron whose element cannot be used: `of_tet` is empty
/// or has an entry per tetrahedron, elements are in range and of a known number of vertices, which
/// are points, and have the corners of the tetrahedron among them.
void require_elements(std::span<const std::int64_t> of_tet, std::span<const VertexId> vertices,
                      std::span<const Tet> tets, std::size_t n_points);

}  // namespace tess::m2m
