#include "m2m/mesh/partition/hilbert_cube.hpp"

#include <algorithm>
#include <array>

namespace tess::m2m {
namespace {

/// Moves bit i of 21 bits to bit 3i.
constexpr std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32U) & 0x001f00000000ffffU;
  x = (x | x << 16U) & 0x001f0000ff0000ffU;
  x = (x | x << 8U) & 0x100f00f00f00f00fU;
  x = (x | x << 4U) & 0x10c30c30c30c30c3U;
  return (x | x << 2U) & 0x1249249249249249U;
}

}  // namespace

HilbertCube::HilbertCube(const Aabb& box) : low_(box.lo) {
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) side = std::max(side, box.hi[axis] - box.lo[axis]);
  if (side > 1e-290) cells_per_length_ = 0x1p21 / side;
}

std::uint64_t HilbertCube::cell(const Point& p) const {
  std::array<std::uint64_t, 3> bits{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = (p[axis] - low_[axis]) * cells_per_length_;
    bits[axis] = spread(static_cast<std::uint64_t>(std::clamp(at, 0.0, 0x1p21 - 1)));
  }
  return bits[0] << 2U | bits[1] << 1U | bits[2];
}

}  // namespace tess::m2m
