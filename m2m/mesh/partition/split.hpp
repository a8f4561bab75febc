// Splits a mesh into parts, one per chare. Each tetrahedron is in exactly one part. A vertex is in
// every part that uses it; the lowest of these parts owns it, and it is a ghost in the others. Only
// the owner receives values for a vertex; it lists the ghosts, and sends new values to them.
// A vertex that no tetrahedron uses is owned by some part.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/mesh_view.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// Vertices that one part owns and another part uses.
struct Ghosts {
  std::int32_t part = 0;            ///< the part that uses them
  std::vector<std::int32_t> here;   ///< their positions among the owner's points, ascending
  std::vector<std::int32_t> there;  ///< their positions among the points of `part`
};

struct MeshPart {
  std::vector<Point> points;  ///< first the n_owned owned ones, then ghosts; each by global id
  std::vector<GlobalId> point_ids;  ///< global ids of points
  std::vector<Tet> tets;            ///< indices into points; first its own, then the halo
  std::vector<GlobalId> tet_ids;    ///< global ids of tets, ascending in each of the two
  std::int64_t n_owned = 0;
  std::int64_t n_own_tets = 0;
  std::vector<Ghosts> ghosts;   ///< ghosts of owned points in other parts, by ascending part
  std::int32_t dimension = 3;   ///< of its cells: TetMesh::dimension
  NativeElements elements{};    ///< of its own tetrahedra; of_tet has -1 for the halo
  bool lacks_elements = false;  ///< since it has no halo, which would hold all of their vertices

  template <class Archive>
  void serialize(Archive& ar) {
    ar(points, point_ids, tets, tet_ids, n_owned, n_own_tets, ghosts, dimension, elements,
       lacks_elements);
  }
};

/// A part as couplings see it, valid as long as the part.
[[nodiscard]] inline MeshView view_of(const MeshPart& part) {
  return {part.points,
          part.tets,
          part.point_ids,
          part.tet_ids,
          part.n_owned,
          part.n_own_tets,
          part.dimension,
          part.elements.of_tet,
          part.elements.vertices,
          part.lacks_elements};
}

/// Returns the parts 0 to n_parts - 1. `parts`: the part of every tetrahedron. `halo_layers`: how
/// many layers of tetrahedra of other parts each part also holds; a layer is what shares a vertex.
[[nodiscard]] std::vector<MeshPart> split(const TetMesh& mesh, std::span<const std::int32_t> parts,
                                          std::int32_t n_parts, std::int32_t halo_layers = 0);

}  // namespace tess::m2m
