#include "collide/serial/buckets.hpp"

#include <limits>

namespace tess::collide::serial {

Slices::Slices(std::span<const Item> sample, std::size_t n_items) {
  constexpr std::size_t n_sample = 32;
  const std::size_t stride = sample.size() / n_sample + 1;
  constexpr double inf = std::numeric_limits<double>::infinity();
  Aabb all{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (std::size_t i = 0; i < sample.size(); i += stride) all = merged(all, sample[i].box);
  double widest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double width = all.hi[k] - all.lo[k];
    if (width > widest) {
      widest = width;
      axis_ = k;
    }
  }
  const std::size_t wanted = std::clamp<std::size_t>(n_items / 4, 1, 1 << 16);
  const double per_slice = static_cast<double>(wanted) / widest;
  if (!(per_slice < inf)) return;  // no extent: one slice
  size_ = wanted;
  low_ = all.lo[axis_];
  per_slice_ = per_slice;
}

void BucketOrder::finish_count() {
  const std::size_t n = reach_.size();
  for (std::size_t s = 0; s < n; ++s) begin_[s + 1] += begin_[s];
  next_.assign(begin_.begin(), begin_.end() - 1);
  first_.resize(n);
  std::size_t at = 0;
  for (std::size_t s = 0; s < n; ++s) {
    while (at < s && (begin_[at] == begin_[at + 1] || reach_[at] < s)) ++at;
    first_[s] = begin_[at];
  }
}

}  // namespace tess::collide::serial
