// Classifies the element types of ExodusII for the reader. A type is free text: programs write
// TETRA, TET4 or tetrahedra, and TRI, TRI3 or TRIANGLE, in upper or lower case.
#pragma once

#include "m2m/io/elements/split_element.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace tess::m2m {

/// 3 for elements with a volume, 2 for surfaces, 1 for lines, 0 for points. `type`: in upper case.
[[nodiscard]] constexpr std::int32_t exodus_dimension(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::int32_t>, 16> known{{{"TRI", 2},
                                                                             {"QUAD", 2},
                                                                             {"SHELL", 2},
                                                                             {"NSIDED", 2},
                                                                             {"BAR", 1},
                                                                             {"BEAM", 1},
                                                                             {"ROD", 1},
                                                                             {"TRUSS", 1},
                                                                             {"SPRING", 1},
                                                                             {"LINE", 1},
                                                                             {"EDGE", 1},
                                                                             {"CURVE", 1},
                                                                             {"NODE", 0},
                                                                             {"SPHERE", 0},
                                                                             {"CIRCLE", 0},
                                                                             {"POINT", 0}}};
  for (const auto& [start, dimension] : known)
    if (type.starts_with(start)) return dimension;
  return 3;
}

/// The element of this name and number of vertices, if it is supported: TET4, TET10, HEX8, HEX27,
/// WEDGE6, PYRAMID5, TRI3, TRI6, QUAD4, SHELL3, SHELL4, BAR2 and other lines of two vertices, also
/// without the number. `type`: in upper case.
[[nodiscard]] constexpr std::optional<ElementType> exodus_supported(std::string_view type,
                                                                    std::int64_t n_vertices) {
  struct Known {
    std::string_view start;
    std::int64_t n;
    std::string_view digits;
    ElementType element;
  };
  constexpr std::array known{
      Known{"TET", 4, "4", ElementType::tet4},     Known{"TET", 10, "10", ElementType::tet10},
      Known{"HEX", 8, "8", ElementType::hex8},     Known{"HEX", 27, "27", ElementType::hex27},
      Known{"WEDGE", 6, "6", ElementType::wedge6}, Known{"PYR", 5, "5", ElementType::pyramid5},
      Known{"TRI", 3, "3", ElementType::tri3},     Known{"TRI", 6, "6", ElementType::tri6},
      Known{"QUAD", 4, "4", ElementType::quad4},   Known{"SHELL", 3, "3", ElementType::tri3},
      Known{"SHELL", 4, "4", ElementType::quad4}};
  const std::string_view digits = type.substr(type.find_last_not_of("0123456789") + 1);
  if (exodus_dimension(type) == 1 && n_vertices == 2) return ElementType::edge2;
  for (const Known& k : known)
    if (type.starts_with(k.start) && n_vertices == k.n && (digits.empty() || digits == k.digits))
      return k.element;
  return std::nullopt;
}

/// The number of sides that are the faces of a surface element; its edges follow. Shells have two,
/// and triangles in three dimensions.
[[nodiscard]] constexpr std::int64_t exodus_faces_before_edges(std::string_view type,
                                                               std::int64_t n_axes) {
  return type.starts_with("SHELL") || (type.starts_with("TRI") && n_axes == 3) ? 2 : 0;
}

}  // namespace tess::m2m
