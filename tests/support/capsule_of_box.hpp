// A capsule around a box: objects that are boxes meet only where their capsules do, so with
// capsules a collider finds the same pairs.
#pragma once

#include "collide/capsule.hpp"

#include <array>
#include <vector>

namespace tess::test {

inline collide::Capsule capsule_of_box(const collide::Aabb& box) {
  std::array<collide::Point, 8> corners;
  for (std::size_t c = 0; c < corners.size(); ++c)
    for (std::size_t k = 0; k < 3; ++k) corners[c][k] = (c >> k & 1U) != 0 ? box.hi[k] : box.lo[k];
  return collide::capsule_around(corners);
}

inline std::vector<collide::Capsule> capsules_of_boxes(std::span<const collide::Aabb> boxes) {
  std::vector<collide::Capsule> out;
  for (const collide::Aabb& box : boxes) out.push_back(capsule_of_box(box));
  return out;
}

}  // namespace tess::test
