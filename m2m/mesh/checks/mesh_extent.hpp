// The sizes of the cells of a mesh, over ranges of it that are joined in any order.
#pragma once

#include "m2m/mesh.hpp"
#include "runtime/core/exact_sum.hpp"

#include <array>

namespace tess::m2m {

struct MeshExtent {
  double longest_squared = 0;  ///< of all edges
  ExactSum volume;             ///< the sum of measure()

  void add(const std::array<Point, 4>& corners, std::int32_t dimension);
  void join(const MeshExtent& other);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(longest_squared, volume);
  }
};

}  // namespace tess::m2m
