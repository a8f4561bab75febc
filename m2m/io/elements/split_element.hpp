// Splits hexahedra, wedges, pyramids and ten-node tetrahedra into linear tetrahedra without new
// vertices. Elements that share a face split it alike, so a conforming mesh stays conforming:
//
//   - a quadrilateral is cut along the diagonal through its vertex of the smallest id;
//   - the element is the pyramid from its vertex of the smallest id over the triangles of the faces
//     that do not hold this vertex (Dompierre, Labbé, Vallet and Camarero 1999, "How to subdivide
//     pyramids, prisms and hexahedra into tetrahedra").
//
// A hexahedron gives six tetrahedra, one of 27 vertices eight times as many, a wedge three, a pyramid
// two. Elements with repeated vertices (a wedge written as a hexahedron) give fewer. A ten-node
// tetrahedron gives eight: four at its corners, and four of the octahedron between them (Bey 1995).
// Kind native evaluates the elements themselves (native_element.hpp). Meshes of surfaces and lines
// have triangles (six-node ones are split into four), quadrilaterals, cut as above, and edges: the
// "tetrahedra" of this file are cells then, as TetMesh::dimension says.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// The order of vertices and the numbers of sides are those of ExodusII; for surfaces those of its
/// plane elements, whose sides are edges.
enum class ElementType : std::uint8_t {
  tet4,
  hex8,
  wedge6,
  pyramid5,
  tet10,
  hex27,
  tri3,
  tri6,
  quad4,
  edge2
};

/// 3 for elements with a volume, 2 for surfaces, 1 for edges.
[[nodiscard]] constexpr std::int32_t dimension_of(ElementType type) noexcept {
  return type < ElementType::tri3 ? 3 : type < ElementType::edge2 ? 2 : 1;
}
/// True for elements that are cells of a TetMesh as they are.
[[nodiscard]] constexpr bool is_simplex(ElementType type) noexcept {
  return type == ElementType::tet4 || type == ElementType::tri3 || type == ElementType::edge2;
}

[[nodiscard]] constexpr const char* name_of(ElementType type) noexcept {
  constexpr std::array names{"TET4",  "HEX8", "WEDGE6", "PYRAMID5", "TET10",
                             "HEX27", "TRI3", "TRI6",   "QUAD4",    "EDGE2"};
  return names[static_cast<std::size_t>(type)];
}

/// Room for those of any type.
using ElementVertices = std::array<VertexId, 27>;
/// Puts the vertices of a hex27 of a format into the order of ExodusII: the k-th from order[k].
inline void reorder(ElementVertices& vertices, const std::array<std::size_t, 27>& order) {
  const ElementVertices given = vertices;
  for (std::size_t k = 0; k < order.size(); ++k) vertices[k] = given[order[k]];
}
[[nodiscard]] std::size_t n_vertices(ElementType type) noexcept;
[[nodiscard]] std::size_t n_sides(ElementType type) noexcept;

/// Appends the cells of an element to `tets`, oriented as the element is. `vertices`:
/// n_vertices(type) ids. Cells that name a corner twice are left out.
void split_element(ElementType type, std::span<const VertexId> vertices, std::vector<Tet>& tets);

/// Adds elements of any type to a mesh as tetrahedra, counts those that are split, and knows which
/// faces of tetrahedra make up a side of an element.
class ElementSplitter {
 public:
  /// `mesh` must outlive the splitter; its tetrahedra are added through the splitter only.
  explicit ElementSplitter(TetMesh& mesh) : mesh_(mesh) {}

  /// Elements added so far.
  [[nodiscard]] GlobalId n_elements() const noexcept { return n_elements_; }

  void add(ElementType type, std::span<const VertexId> vertices);
  /// Sides of an element (from 0 on) as numbers from 1 on; 0 if there is no such element.
  [[nodiscard]] std::size_t n_sides_of(GlobalId element) const;
  /// Appends the faces that make up a side of an element.
  void append_side(GlobalId element, std::int64_t side, std::vector<Side>& sides) const;
  /// Fills mesh.split, mesh.element_of_tet and mesh.elements. The points of the mesh are there.
  void finish();

 private:
  /// Consecutive elements of one type. Tetrahedra need no lists.
  struct Run {
    ElementType type;
    GlobalId first_element = 0;
    GlobalId first_tet = 0;
    std::int64_t first_vertex = 0;       // of its first element, in mesh.elements
    std::vector<GlobalId> first_tets{};  // per element
    [[nodiscard]] std::int64_t begin_of(std::size_t number) const {
      return first_vertex + static_cast<std::int64_t>(number * (1 + n_vertices(type)));
    }
  };
  [[nodiscard]] const Run* run_of(GlobalId element) const;
  /// Elements with tetrahedra of both orientations, of those that the tetrahedra in a range make up.
  [[nodiscard]] std::uint64_t n_folded(GlobalId begin, GlobalId end) const;

  TetMesh& mesh_;
  std::vector<Run> runs_;
  GlobalId n_elements_ = 0;
};

}  // namespace tess::m2m
