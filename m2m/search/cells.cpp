#include "m2m/search/cells.hpp"

#include <cmath>

namespace tess::m2m {

Cells::Cells(const Aabb& box, std::size_t n_wanted) {
  Point extent{};
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    extent[axis] = box.hi[axis] - box.lo[axis];
    longest = std::max(longest, extent[axis]);
  }
  if (!(longest > 0) || n_wanted <= 1) return;
  // Relative to the longest, so that no product leaves the range of double. An axis of less than a
  // thousandth counts as flat.
  double volume = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) volume *= std::max(extent[axis] / longest, 1e-3);
  const double edge = std::cbrt(volume / static_cast<double>(n_wanted));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n = std::clamp(std::ceil(extent[axis] / longest / edge), 1.0, 1048576.0);
    const double per_length = n / extent[axis];
    low_[axis] = box.lo[axis];
    if (n == 1 || !std::isfinite(per_length)) continue;
    per_length_[axis] = per_length;
    last_[axis] = n - 1;
    size_[axis] = static_cast<std::int32_t>(n);
  }
}

}  // namespace tess::m2m
