// Splits hexahedra, wedges, pyramids and ten-node tetrahedra into linear tetrahedra without new
// vertices. Elements that share a face split it alike, so a conforming mesh stays conforming:
//
//   - a quadrilateral is cut along the diagonal through its vertex of the smallest id;
//   - the element is the pyramid from its vertex of the smallest id over the triangles of the faces
//     that do not hold this vertex (Dompierre, Labbé, Vallet and Camarero 1999, "How to subdivide
//     pyramids, prisms and hexahedra into tetrahedra").
//
// A hexahedron gives six tetrahedra, a wedge three, a pyramid two. Elements with repeated vertices
// (a wedge written as a hexahedron) give fewer. A ten-node tetrahedron gives eight: four at its
// corners, and four of the octahedron between them (Bey 1995); tet10.hpp evaluates it as a quadratic
// element.
#pragma once

#include "m2m/mesh.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tess::m2m {

/// Volume elements. The order of vertices and the numbers of sides are those of ExodusII.
enum class ElementType : std::uint8_t { tet4, hex8, wedge6, pyramid5, tet10 };

[[nodiscard]] std::size_t n_vertices(ElementType type) noexcept;
[[nodiscard]] std::size_t n_sides(ElementType type) noexcept;

/// Appends the tetrahedra of an element to `tets`, oriented as the element is. `vertices`:
/// n_vertices(type) ids. Tetrahedra that name a vertex twice are left out.
void split_element(ElementType type, std::span<const VertexId> vertices, std::vector<Tet>& tets);

/// Elements of one type that were split, with their tetrahedra in a mesh.
class SplitBlock {
 public:
  explicit SplitBlock(ElementType type) : type_(type) {}

  [[nodiscard]] ElementType type() const noexcept { return type_; }
  [[nodiscard]] std::size_t n_elements() const noexcept { return first_tet_.size(); }

  /// Splits an element into tetrahedra at the end of `mesh`.
  void add(std::span<const VertexId> vertices, TetMesh& mesh);
  /// Appends the faces of tetrahedra that make up a side (from 1 on) of an element (from 0 on).
  void append_side(std::size_t element, std::int64_t side, const TetMesh& mesh,
                   std::vector<Side>& sides) const;

 private:
  ElementType type_;
  std::vector<VertexId> vertices_;   // of all elements
  std::vector<GlobalId> first_tet_;  // per element, in the mesh
  GlobalId end_ = 0;                 // after the tetrahedra of the last element
};

}  // namespace tess::m2m
