// Classifies the element types of ExodusII for the reader. A type is free text: programs write
// TETRA, TET4 or tetrahedra, and TRI, TRI3 or TRIANGLE, in upper or lower case.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tess::m2m {

enum class ExodusElement {
  tetrahedron,  ///< with four vertices: read
  no_volume,    ///< surfaces, lines and points: skipped
  other         ///< solids that are not supported, and unknown types
};

/// `type`: in upper case.
[[nodiscard]] constexpr ExodusElement exodus_element(std::string_view type,
                                                     std::int64_t n_vertices) {
  constexpr std::string_view digits = "0123456789";
  if (type.starts_with("TET")) {
    const std::string_view count = type.substr(type.find_last_not_of(digits) + 1);
    return n_vertices == 4 && (count.empty() || count == "4") ? ExodusElement::tetrahedron
                                                              : ExodusElement::other;
  }
  constexpr std::array no_volume{"TRI",  "QUAD", "SHELL", "BAR",    "BEAM",   "TRUSS", "ROD",
                                 "LINE", "EDGE", "CURVE", "SPHERE", "CIRCLE", "POINT", "NODE"};
  for (const std::string_view start : no_volume)
    if (type.starts_with(start)) return ExodusElement::no_volume;
  return ExodusElement::other;
}

}  // namespace tess::m2m
