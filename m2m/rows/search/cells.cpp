#include "m2m/rows/search/cells.hpp"

#include <cmath>

namespace tess::m2m {

Cells::Cells(const Aabb& box, std::size_t n_wanted) {
  Point extent{};
  for (std::size_t axis = 0; axis < 3; ++axis) extent[axis] = box.hi[axis] - box.lo[axis];
  const double longest = std::max({extent[0], extent[1], extent[2]});
  if (!(longest > 0) || n_wanted <= 1) return;
  // Relative to the longest, so that no product leaves the range of double.
  for (double& e : extent) e /= longest;
  Point sorted = extent;
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(n_wanted);
  double edge = std::cbrt(sorted[1] * sorted[0] / n);
  if (sorted[0] <= edge) edge = std::sqrt(sorted[1] / n);  // a single layer
  if (sorted[1] <= edge) edge = 1 / n;                     // a single row
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double n_here = std::max(std::ceil(extent[axis] / edge), 1.0);
    const double per_length = n_here / (extent[axis] * longest);
    if (n_here == 1 || !std::isfinite(per_length)) continue;
    low_[axis] = box.lo[axis];
    per_length_[axis] = per_length;
    last_[axis] = n_here - 1;
    size_[axis] = static_cast<std::int32_t>(n_here);
  }
}

}  // namespace tess::m2m
