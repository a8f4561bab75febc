// The donor of a target point: the source vertices that give it its value, with their weights. The
// field's word, from overset grids.
#pragma once

#include "m2m/rows/interpolate/locate.hpp"

#include <array>
#include <type_traits>

namespace tess::m2m {

/// The value is the sum of weight × value over the vertices. A single vertex has the weight 1.
struct Donor {
  std::array<VertexId, 4> vertices{};
  Weights weights{};
};
static_assert(std::is_trivially_copyable_v<Donor> && sizeof(Donor) == 48);

[[nodiscard]] inline Donor donor_at(VertexId vertex) {
  return {{vertex, vertex, vertex, vertex}, {1, 0, 0, 0}};
}

}  // namespace tess::m2m
