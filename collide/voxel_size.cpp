#include "collide/voxel_size.hpp"

#include <vector>

namespace tess::collide {

double suggested_voxel_size(std::span<const Item> items) {
  constexpr std::size_t kSample = 4096;
  if (items.empty()) return 1;
  std::vector<double> extents;
  Aabb all = items.front().box;
  const std::size_t stride = (items.size() + kSample - 1) / kSample;
  for (std::size_t i = 0; i < items.size(); i += stride) {
    const Aabb& box = items[i].box;
    all = merged(all, box);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, box.hi[k] - box.lo[k]);
    if (longest > 0) extents.push_back(longest);
  }
  double widest = 0, largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    widest = std::max(widest, all.hi[k] - all.lo[k]);
    largest = std::max({largest, std::abs(all.lo[k]), std::abs(all.hi[k])});
  }
  double size = 0;
  if (extents.empty()) {
    size = widest / std::max(1.0, std::cbrt(static_cast<double>(items.size()) / 8));
  } else {
    const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(extents.size() / 2);
    std::nth_element(extents.begin(), middle, extents.end());
    size = 2 * *middle;
  }
  // Indices must fit in 32 bits, with a margin for items outside the sample. The size and its
  // inverse must be finite.
  size = std::clamp(std::max(size, largest / (1 << 28)), 1e-300, 1e300);
  return size;
}

}  // namespace tess::collide
