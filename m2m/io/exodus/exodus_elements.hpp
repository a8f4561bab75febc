// Classifies the element types of ExodusII for the reader. A type is free text: programs write
// TETRA, TET4 or tetrahedra, and TRI, TRI3 or TRIANGLE, in upper or lower case.
#pragma once

#include "m2m/io/elements/split_element.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tess::m2m {

/// The volume element of this name and number of vertices, if it is supported: TET4, TET10, HEX8,
/// WEDGE6, PYRAMID5, also without the number. `type`: in upper case.
[[nodiscard]] constexpr std::optional<ElementType> exodus_volume(std::string_view type,
                                                                 std::int64_t n_vertices) {
  struct Known {
    std::string_view start;
    std::int64_t n;
    std::string_view digits;
    ElementType element;
  };
  constexpr std::array known{
      Known{"TET", 4, "4", ElementType::tet4}, Known{"TET", 10, "10", ElementType::tet10},
      Known{"HEX", 8, "8", ElementType::hex8}, Known{"WEDGE", 6, "6", ElementType::wedge6},
      Known{"PYR", 5, "5", ElementType::pyramid5}};
  const std::string_view digits = type.substr(type.find_last_not_of("0123456789") + 1);
  for (const Known& k : known)
    if (type.starts_with(k.start) && n_vertices == k.n && (digits.empty() || digits == k.digits))
      return k.element;
  return std::nullopt;
}

/// True for surfaces, lines and points, which are skipped. `type`: in upper case.
[[nodiscard]] constexpr bool exodus_has_no_volume(std::string_view type) {
  constexpr std::array no_volume{"TRI",  "QUAD",   "SHELL",  "NSIDED", "BAR",  "BEAM",
                                 "ROD",  "TRUSS",  "SPRING", "LINE",   "EDGE", "CURVE",
                                 "NODE", "SPHERE", "CIRCLE", "POINT"};
  for (const std::string_view start : no_volume)
    if (type.starts_with(start)) return true;
  return false;
}

}  // namespace tess::m2m
