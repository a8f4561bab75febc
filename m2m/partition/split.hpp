// One part of a mesh, ready to be given to the chare that carries it. Each tetrahedron is in
// exactly one part. A vertex is in every part that uses it, and owned by exactly one: the lowest
// such part. Target values are held by owners, so that each is received once. A vertex that no
// tetrahedron uses is owned by some part, never lost. In the other parts that use it, a vertex is a
// ghost: its owner knows of them, so that new values can follow.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// Vertices that one part owns and another one uses.
struct Ghosts {
  std::int32_t part = 0;            ///< that uses them
  std::vector<std::int32_t> here;   ///< their places among the owner's points, ascending
  std::vector<std::int32_t> there;  ///< and among that part's points
};

struct MeshPart {
  std::vector<Point> points;  ///< the n_owned owned ones first; each group in ascending global id
  std::vector<GlobalId> point_ids;  ///< of points, in the whole mesh
  std::vector<Tet> tets;            ///< indices into points
  std::vector<GlobalId> tet_ids;    ///< of tets, in the whole mesh; ascending
  std::int64_t n_owned = 0;
  std::vector<Ghosts> ghosts;  ///< of owned points, by ascending part

  /// For the runtime's archives.
  template <class Archive>
  void serialize(Archive& ar) {
    ar(points, point_ids, tets, tet_ids, n_owned, ghosts);
  }
};

/// The parts 0 to n_parts - 1. `parts`: the part of every tetrahedron.
[[nodiscard]] std::vector<MeshPart> split(const TetMesh& mesh, std::span<const std::int32_t> parts,
                                          std::int32_t n_parts);

/// The rows of a field that belong to the points of a part: part.points.size() × n_components.
[[nodiscard]] std::vector<double> values_of(const MeshPart& part, const Field& field);

}  // namespace tess::m2m
