// What is known of the boxes before a search: their bounds, whether all are valid, and their longest
// extents.
#pragma once

#include "collide/box.hpp"

#include <cstddef>
#include <span>

namespace tess::collide::search {

template <class Real, std::size_t D>
[[nodiscard]] Real longest_extent(const Box<Real, D>& box) noexcept {
  Real longest = 0;
  for (std::size_t k = 0; k < D; ++k) longest = std::max(longest, box.hi[k] - box.lo[k]);
  return longest;
}

/// The bounds of boxes. Throws Error (bad_value) with the position of the first box that is not
/// valid; `set` is "" or " of the second set" and the like.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> checked_bounds(std::span<const Box<Real, D>> boxes, const char* set);

}  // namespace tess::collide::search
