// A tetrahedral mesh: points and tetrahedra in file order. The readers (read_mesh.hpp) or the
// application create it. validate() checks it once; it does not change after that. The position of
// a vertex or tetrahedron in these lists is its global id; hashes, ties and output follow the
// global ids. Counts have 64 bits. Vertex ids within a mesh have 32 bits, so a mesh holds at most
// 2^31 - 1 vertices.
#pragma once

#include "collide/box.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tess::m2m {

using collide::Aabb;
using collide::cross;
using collide::difference;
using collide::dot;
using collide::Point;
/// A vertex of one mesh, or of one part of it.
using VertexId = std::int32_t;
/// A vertex or tetrahedron in the numbering of the whole mesh.
using GlobalId = std::int64_t;
/// The four vertices of a tetrahedron. Its orientation may be positive or negative.
using Tet = std::array<VertexId, 4>;

/// Consecutive tetrahedra with a number and a name, as in an ExodusII file.
struct Block {
  std::int64_t id = 1;
  std::string name{};
  std::size_t n_tets = 0;
  friend bool operator==(const Block&, const Block&) = default;
};
/// A face of a tetrahedron, numbered as in ExodusII: side 1 is opposite to corner 2, side 2 to
/// corner 0, side 3 to corner 1, side 4 to corner 3. Of a triangle it is an edge: side 1 from corner
/// 0 to 1, side 2 from 1 to 2, side 3 from 2 to 0. Of an edge it is an end: corner 0, corner 1.
struct Side {
  GlobalId tet = 0;
  std::int32_t side = 1;
  friend bool operator==(const Side&, const Side&) = default;
};
/// Faces or vertices with a number and a name.
template <class Entry>
struct EntrySet {
  std::int64_t id = 1;
  std::string name{};
  std::vector<Entry> entries{};
  std::vector<double> factors{};  ///< distribution factors of ExodusII in file order; often empty
  friend bool operator==(const EntrySet&, const EntrySet&) = default;
};
using SideSet = EntrySet<Side>;
using NodeSet = EntrySet<VertexId>;

/// Elements of a file that have no volume. The reader leaves them out and counts them.
struct Skipped {
  std::string type{};
  std::uint64_t n_elements = 0;
  friend bool operator==(const Skipped&, const Skipped&) = default;
};

/// Elements of a file with a volume that the reader split into tetrahedra.
struct SplitElements {
  std::string type{};
  std::uint64_t n_elements = 0;
  std::uint64_t n_tets = 0;
  /// Elements with tetrahedra of both orientations, which overlap: their vertices stand in another
  /// order than that of the format, or they are too distorted.
  std::uint64_t n_folded = 0;
  friend bool operator==(const SplitElements&, const SplitElements&) = default;
};

/// Elements with shape functions of their own: TET10, HEX8, HEX27, WEDGE6 and PYRAMID5 by their
/// numbers of vertices.
[[nodiscard]] constexpr bool is_native(std::int64_t n_vertices) noexcept {
  return n_vertices == 27 || n_vertices == 10 || n_vertices == 8 || n_vertices == 6 ||
         n_vertices == 5;
}
/// The vertices of the element that begins there in NativeElements::vertices.
[[nodiscard]] inline std::span<const VertexId> vertices_of_element(std::span<const VertexId> all,
                                                                   std::int64_t begin) {
  const auto at = static_cast<std::size_t>(begin);
  return all.subspan(at + 1, static_cast<std::size_t>(all[at]));
}
/// The elements that tetrahedra were split from. Kind `native` uses their shape functions.
struct NativeElements {
  /// Per tetrahedron, where its element begins in `vertices`; -1 if it is an element itself. Empty
  /// if all are, and of surfaces.
  std::vector<std::int64_t> of_tet{};
  /// Per element how many vertices it has, which says its type, and then these in the order of
  /// ExodusII.
  std::vector<VertexId> vertices{};

  [[nodiscard]] std::span<const VertexId> vertices_at(std::int64_t begin) const {
    return vertices_of_element(vertices, begin);
  }
  template <class Archive>
  void serialize(Archive& ar) {
    ar(of_tet, vertices);
  }
};

struct TetMesh {
  std::string name;             ///< a path, "kuhn:8", or a name that the application chooses
  std::vector<Point> points;    ///< n_points × 3
  std::vector<Tet> tets;        ///< n_tets × 4, indices into points
  std::vector<Block> blocks{};  ///< cover all tetrahedra in order; empty means one block
  std::vector<SideSet> side_sets{};
  std::vector<NodeSet> node_sets{};
  std::vector<Skipped> skipped{};
  std::vector<SplitElements> split{};  ///< per type; empty if all elements are tetrahedra
  /// Gives each tetrahedron its element among all with a volume, in the order of the file. It is
  /// empty if all elements are tetrahedra.
  std::vector<GlobalId> element_of_tet{};
  /// 3: the cells are tetrahedra. A wall or a plane mesh has 2: its cells are triangles, which
  /// repeat their last vertex (a, b, c, c). A line has 1: its cells are edges (a, b, b, b).
  std::int32_t dimension = 3;
  NativeElements elements{};

  [[nodiscard]] std::size_t n_points() const noexcept { return points.size(); }
  [[nodiscard]] std::size_t n_tets() const noexcept { return tets.size(); }
};

/// Properties of a valid mesh that are worth a report.
struct MeshCensus {
  std::size_t n_flat = 0;      ///< cells without measure(), for example with two equal vertices
  std::size_t n_inverted = 0;  ///< tetrahedra of negative orientation
  std::size_t n_unused = 0;    ///< vertices that no tetrahedron uses
  Aabb bounds{};               ///< of all points
};

/// Throws Error (bad_mesh) with the mesh, the element and the remedy if
///   - the mesh has no tetrahedra, or cells that are not of its dimension,
///   - a coordinate is not finite or exceeds 1e100,
///   - an index is out of range, also in a block or set,
///   - more than a tenth of the tetrahedra are shorter than 64 ulps of their coordinates (their
///     shape is rounding error, and points snap within 4 ulps) or shorter than 1e-80 (their volumes
///     underflow),
///   - no tetrahedron has a volume, no triangle an area, or no edge a length.
/// Single flat, tiny or inverted tetrahedra are allowed; flat and inverted ones are counted.
MeshCensus validate(const TetMesh& mesh);

/// "120 TRI3, 8 BAR2"; empty if the reader skipped nothing.
[[nodiscard]] std::string skipped_text(const TetMesh& mesh);

/// "27 HEX8 into 162 tetrahedra", and how many are folded; empty if the reader split nothing.
[[nodiscard]] std::string split_text(const TetMesh& mesh);

/// The number of vertices that belong to no element.
[[nodiscard]] std::size_t n_unused(const TetMesh& mesh);
/// "24 of 812 vertices belong to no element"; empty if there are none.
[[nodiscard]] std::string unused_text(std::size_t n_unused, std::size_t n_points);

/// "24 of 812 vertices have the place of another"; empty if there are none. A transfer of the mesh
/// onto itself does not tell them apart.
[[nodiscard]] std::string coincident_text(const TetMesh& mesh);

/// "162 of 324 tetrahedra have the corners of another"; empty if there are none. Integrals count
/// them as often as they are there.
[[nodiscard]] std::string repeated_text(const TetMesh& mesh);

/// The box around all points.
[[nodiscard]] Aabb bounds(const TetMesh& mesh);

/// The volume with its sign, from edges relative to the first vertex. (Absolute coordinates would
/// cancel far from the origin.)
[[nodiscard]] double signed_volume(const TetMesh& mesh, std::size_t tet);
// Each coordinate is read alone: a copy of the corners in vectors waits for the stores that have
// just written them.
[[nodiscard]] inline double signed_volume(const std::array<Point, 4>& corners) {
  const double x = corners[0][0], y = corners[0][1], z = corners[0][2];
  const double ax = corners[1][0] - x, ay = corners[1][1] - y, az = corners[1][2] - z;
  const double bx = corners[2][0] - x, by = corners[2][1] - y, bz = corners[2][2] - z;
  const double cx = corners[3][0] - x, cy = corners[3][1] - y, cz = corners[3][2] - z;
  return (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6.0;
}
/// The area of a triangle (dimension 2) or the length of an edge (1).
[[nodiscard]] double area_or_length(const std::array<Point, 4>& corners, std::int32_t dimension);
/// The size of a cell of this dimension, never negative: the volume of a tetrahedron, the area of a
/// triangle, or the length of an edge.
[[nodiscard]] inline double measure(const std::array<Point, 4>& corners, std::int32_t dimension) {
  return dimension == 3 ? std::abs(signed_volume(corners)) : area_or_length(corners, dimension);
}

/// For messages: the cells of this dimension, "tetrahedra", "triangles" or "edges".
[[nodiscard]] constexpr const char* cells_of(std::int32_t dimension) noexcept {
  return dimension == 3 ? "tetrahedra" : dimension == 2 ? "triangles" : "edges";
}
[[nodiscard]] constexpr const char* cell_of(std::int32_t dimension) noexcept {
  return dimension == 3 ? "tetrahedron" : dimension == 2 ? "triangle" : "edge";
}
/// True if the cell repeats its last vertex as the dimension asks: (a, b, c, c) or (a, b, b, b).
[[nodiscard]] constexpr bool has_dimension(const Tet& cell, std::int32_t dimension) noexcept {
  return dimension == 3 || (cell[3] == cell[2] && (dimension == 2 || cell[2] == cell[1]));
}

/// The four points of a cell.
[[nodiscard]] inline std::array<Point, 4> corners_of(std::span<const Point> points,
                                                     const Tet& tet) {
  const auto at = [&](std::size_t corner) { return points[static_cast<std::size_t>(tet[corner])]; };
  return {at(0), at(1), at(2), at(3)};
}

/// The mean of the corners; of a triangle (dimension 2) that of the first three.
[[nodiscard]] inline Point mean_of_corners(const std::array<Point, 4>& corners,
                                           std::int32_t dimension = 3) {
  Point mean{};
  for (std::size_t a = 0; a <= static_cast<std::size_t>(dimension); ++a)
    for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += corners[a][axis] / (dimension + 1);
  return mean;
}

}  // namespace tess::m2m
