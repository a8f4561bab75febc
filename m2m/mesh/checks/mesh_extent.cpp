#include "m2m/mesh/checks/mesh_extent.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tess::m2m {

void MeshExtent::add(const std::array<Point, 4>& corners, std::int32_t dimension) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      double squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = corners[i][axis] - corners[j][axis];
        squared += d * d;
      }
      longest_squared = std::max(longest_squared, squared);
    }
  volume.add(measure(corners, dimension));
}

void MeshExtent::join(const MeshExtent& other) {
  longest_squared = std::max(longest_squared, other.longest_squared);
  volume.add(other.volume);
}

}  // namespace tess::m2m
