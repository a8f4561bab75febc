// The objects of each PE, which the PE computes by itself.
#pragma once

#include "apps/collide_scaling/case.hpp"
#include "collide/parallel/object_list.hpp"

#include <vector>

namespace collide_scaling {

/// The boxes of one model.
struct Body {
  tess::collide::ModelId model{};
  std::vector<tess::collide::Aabb> boxes;
};

/// A PE has a rectangle of two near-parallel wavy planes; each plane is a model.
[[nodiscard]] std::vector<Body> tile_of(const Case& given, std::int32_t pe);

/// A PE has bodies of a crowd that are near each other at the beginning; each body is a model.
[[nodiscard]] std::vector<Body> bodies_of(const Case& given, std::int32_t pe, std::int32_t step);

}  // namespace collide_scaling
