// A tetrahedral mesh as every part of the transfer sees it: points and tetrahedra in file order.
// Made by the readers (io/read_mesh.hpp) or by the calling application, checked once by validate(),
// immutable after that. The place of a vertex or tetrahedron in these lists is its global id:
// hashes, tie rules and output follow it. Counts are 64 bits; vertex ids inside a mesh are 32 bits,
// so one mesh holds at most 2^31 - 1 vertices.
#pragma once

#include "collide/aabb.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tess::m2m {

using collide::Aabb;
using collide::Point;
/// A vertex within one mesh or one part.
using VertexId = std::int32_t;
/// A vertex or tetrahedron in the numbering of the whole mesh.
using GlobalId = std::int64_t;
/// The four vertices of a tetrahedron; its orientation may be of either sign.
using Tet = std::array<VertexId, 4>;

/// Consecutive tetrahedra under a number and a name, as a file has them.
struct Block {
  std::int64_t id = 1;
  std::string name{};
  std::size_t n_tets = 0;
  friend bool operator==(const Block&, const Block&) = default;
};
/// A face of a tetrahedron: side 1 is opposite to corner 2, side 2 to corner 0, side 3 to corner 1,
/// side 4 to corner 3 (ExodusII).
struct Side {
  GlobalId tet = 0;
  std::int32_t side = 1;
  friend bool operator==(const Side&, const Side&) = default;
};
/// Faces or vertices under a number and a name. `factors` are the distribution factors of ExodusII,
/// in the file's order; often empty.
template <class Entry>
struct EntrySet {
  std::int64_t id = 1;
  std::string name{};
  std::vector<Entry> entries{};
  std::vector<double> factors{};
  friend bool operator==(const EntrySet&, const EntrySet&) = default;
};
using SideSet = EntrySet<Side>;
using NodeSet = EntrySet<VertexId>;

/// Elements of a file that are no volumes, and were left out.
struct Skipped {
  std::string type{};
  std::uint64_t n_elements = 0;
  friend bool operator==(const Skipped&, const Skipped&) = default;
};

struct TetMesh {
  std::string name;  ///< where it came from: a path, "kuhn:8", or what the application says
  std::vector<Point> points;    ///< n_points × 3
  std::vector<Tet> tets;        ///< n_tets × 4, indices into points
  std::vector<Block> blocks{};  ///< all tetrahedra in order; or none, which means one block
  std::vector<SideSet> side_sets{};
  std::vector<NodeSet> node_sets{};
  std::vector<Skipped> skipped{};

  [[nodiscard]] std::size_t n_points() const noexcept { return points.size(); }
  [[nodiscard]] std::size_t n_tets() const noexcept { return tets.size(); }
};

/// What validate() found that is allowed but worth saying.
struct MeshCensus {
  std::size_t n_flat = 0;      ///< tetrahedra without volume, or with two equal vertices
  std::size_t n_inverted = 0;  ///< tetrahedra of negative orientation
  std::size_t n_unused = 0;    ///< vertices that no tetrahedron uses
  Aabb bounds{};               ///< of all points
};

/// Throws Error (bad_mesh), naming the mesh, the element and the remedy, on no tetrahedra, a
/// coordinate that is not finite, an index out of range (also of a block or set), or coordinates
/// that cannot be computed with: where more than a tenth of the tetrahedra are shorter than 64 ulps
/// of their coordinates (so close to the tolerance of 4 ulps with which points snap, their shape is
/// rounding), shorter than 1e-80 (volumes leave the range of double), or where none has a volume.
/// Single flat, tiny or inverted tetrahedra pass; flat and inverted ones are counted.
MeshCensus validate(const TetMesh& mesh);

/// "120 TRI3, 8 BAR2"; empty where nothing was skipped.
[[nodiscard]] std::string skipped_text(const TetMesh& mesh);

/// The box around all points.
[[nodiscard]] Aabb bounds(const TetMesh& mesh);

/// Volume with sign, from edges relative to the first vertex (absolute coordinates would cancel far
/// from the origin).
[[nodiscard]] double signed_volume(const TetMesh& mesh, std::size_t tet);

}  // namespace tess::m2m
