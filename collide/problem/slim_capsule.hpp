// Capsules in eight floats, eight pairs of which are compared at a time. A pair is rejected if the
// two capsules are apart along the axis that is at right angles to both: for two needles in space
// that is nearly every pair that does not meet. What is rejected is certainly apart, for rounding
// makes capsules larger; parallel capsules are never rejected.
#pragma once

#include "collide/capsule.hpp"

#include <cstddef>
#include <cstdint>

namespace tess::collide::search {

/// Coordinates of slim capsules are (x - centre) * scale, and are in [-1, 1] for objects within the
/// bounds. The scale is a power of two.
struct Frame {
  Point centre{};
  double scale = 1;
};
[[nodiscard]] Frame frame_of(const Aabb& bounds) noexcept;

/// Contains a capsule.
struct alignas(32) SlimCapsule {
  std::array<float, 3> from, along;
  float radius;  ///< infinite: nothing is known
  float unused = 0;
};
[[nodiscard]] SlimCapsule slim(const Capsule& capsule, const Frame& frame) noexcept;

/// Writes the m < n to `out` for which capsules a[in_a[m]] and b[in_b[m]] may have a common point,
/// and returns how many they are. `out` has room for n + 8.
std::size_t may_meet(const SlimCapsule* a, const SlimCapsule* b, const std::uint32_t* in_a,
                     const std::uint32_t* in_b, std::size_t n, std::uint32_t* out) noexcept;

}  // namespace tess::collide::search
