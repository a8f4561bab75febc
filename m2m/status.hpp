// Where a target vertex lies with respect to the source mesh: the result of the point location,
// reported for every target vertex.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tess::m2m {

enum class Status : std::uint8_t {
  inside,    ///< strictly inside a tetrahedron
  boundary,  ///< exactly on a face, edge or vertex of a tetrahedron
  snapped,   ///< outside every tetrahedron, but within the tolerance of one
  outside,   ///< in no tetrahedron: the policy gives the value
};

[[nodiscard]] constexpr const char* name_of(Status status) noexcept {
  constexpr std::array names{"inside", "boundary", "snapped", "outside"};
  return names[static_cast<std::size_t>(status)];
}

}  // namespace tess::m2m
