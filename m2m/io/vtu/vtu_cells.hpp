// The cell types of VTK (vtkCellType.h), for the reader of VTU files.
#pragma once

#include "m2m/io/elements/split_element.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tess::m2m {

struct VtuCell {
  int number;
  std::string_view name;
  int dimension;
};

inline constexpr VtuCell vtu_cells[] = {
    {0, "empty", 0},
    {1, "vertex", 0},
    {2, "poly vertex", 0},
    {3, "line", 1},
    {4, "poly line", 1},
    {5, "triangle", 2},
    {6, "triangle strip", 2},
    {7, "polygon", 2},
    {8, "pixel", 2},
    {9, "quad", 2},
    {10, "tetra", 3},
    {11, "voxel", 3},
    {12, "hexahedron", 3},
    {13, "wedge", 3},
    {14, "pyramid", 3},
    {15, "pentagonal prism", 3},
    {16, "hexagonal prism", 3},
    {21, "quadratic edge", 1},
    {22, "quadratic triangle", 2},
    {23, "quadratic quad", 2},
    {24, "quadratic tetra", 3},
    {25, "quadratic hexahedron", 3},
    {26, "quadratic wedge", 3},
    {27, "quadratic pyramid", 3},
    {28, "biquadratic quad", 2},
    {29, "triquadratic hexahedron", 3},
    {30, "quadratic linear quad", 2},
    {31, "quadratic linear wedge", 3},
    {32, "biquadratic quadratic wedge", 3},
    {33, "biquadratic quadratic hexahedron", 3},
    {34, "biquadratic triangle", 2},
    {35, "cubic line", 1},
    {36, "quadratic polygon", 2},
    {37, "triquadratic pyramid", 3},
    {42, "polyhedron", 3},
    {68, "Lagrange curve", 1},
    {69, "Lagrange triangle", 2},
    {70, "Lagrange quadrilateral", 2},
    {71, "Lagrange tetrahedron", 3},
    {72, "Lagrange hexahedron", 3},
    {73, "Lagrange wedge", 3},
    {74, "Lagrange pyramid", 3},
};

/// The type with this number, or null if there is none.
constexpr const VtuCell* vtu_cell(std::int64_t number) {
  for (const VtuCell& cell : vtu_cells)
    if (cell.number == number) return &cell;
  return nullptr;
}

/// The element of a type with this number of vertices, if it is supported. A voxel is a hexahedron in
/// another order, and a pixel a quadrilateral. Lagrange cells of degree 1, and Lagrange triangles and
/// tetrahedra of degree 2, have the points of the other types in the same order.
constexpr std::optional<ElementType> vtu_supported(std::int64_t number, std::size_t n_vertices) {
  switch (number) {
    case 4:
    case 68:
      return n_vertices == 2 ? std::optional(ElementType::edge2) : std::nullopt;
    case 3:
      return ElementType::edge2;
    case 7:
    case 69:
    case 70:
      return n_vertices == 3 && number != 70   ? std::optional(ElementType::tri3)
             : n_vertices == 4 && number != 69 ? std::optional(ElementType::quad4)
             : n_vertices == 6 && number == 69 ? std::optional(ElementType::tri6)
                                               : std::nullopt;
    case 5:
      return ElementType::tri3;
    case 8:
    case 9:
      return ElementType::quad4;
    case 22:
      return ElementType::tri6;
    case 71:
      return n_vertices == 4    ? std::optional(ElementType::tet4)
             : n_vertices == 10 ? std::optional(ElementType::tet10)
                                : std::nullopt;
    case 72:
      return n_vertices == 8 ? std::optional(ElementType::hex8) : std::nullopt;
    case 73:
      return n_vertices == 6 ? std::optional(ElementType::wedge6) : std::nullopt;
    case 74:
      return n_vertices == 5 ? std::optional(ElementType::pyramid5) : std::nullopt;
    case 10:
      return ElementType::tet4;
    case 11:
    case 12:
      return ElementType::hex8;
    case 29:
      return ElementType::hex27;
    case 13:
      return ElementType::wedge6;
    case 14:
      return ElementType::pyramid5;
    case 24:
      return ElementType::tet10;
    default:
      return std::nullopt;
  }
}

/// The vertices of a hex27 of ExodusII in a triquadratic hexahedron.
inline constexpr std::array<std::size_t, 27> vtu_hex27{0,  1,  2,  3,  4,  5,  6,  7,  8,
                                                       9,  10, 11, 16, 17, 18, 19, 12, 13,
                                                       14, 15, 26, 24, 25, 20, 21, 22, 23};

/// 0 to 3, also of types that are not supported; -1 for a number that is no type.
constexpr int vtu_dimension(std::int64_t number) {
  const VtuCell* const cell = vtu_cell(number);
  return cell == nullptr ? -1 : cell->dimension;
}

}  // namespace tess::m2m
