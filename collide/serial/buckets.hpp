// Sorts boxes into slices along one axis, for a sweep, without a comparison sort. The slice is a
// monotone function of the coordinate. So if a box may overlap a box that reaches from lo to hi,
// its lower corner lies in the slice of hi or an earlier one, and its position is not before
// first(lo). The sweep tests only this range of positions. The choice of the slices affects only
// the speed.
#pragma once

#include "collide/hit.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace tess::collide::serial {

/// Slices along the axis on which the boxes spread most.
class Slices {
 public:
  /// One slice per four items. A sample of the items decides the axis and the bounds.
  explicit Slices(std::span<const Item> sample, std::size_t n_items);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::uint32_t of(double x) const noexcept {
    const double slice = (x - low_) * per_slice_;
    return static_cast<std::uint32_t>(std::clamp(slice, 0.0, static_cast<double>(size_ - 1)));
  }
  [[nodiscard]] std::uint32_t of_lo(const Item& item) const noexcept {
    return of(item.box.lo[axis_]);
  }
  [[nodiscard]] std::uint32_t of_hi(const Item& item) const noexcept {
    return of(item.box.hi[axis_]);
  }
  [[nodiscard]] std::size_t axis() const noexcept { return axis_; }

 private:
  std::size_t axis_ = 0;
  std::size_t size_ = 1;
  double low_ = 0;
  double per_slice_ = 0;
};

/// The order of items by slice, and the range of possible partners. It keeps its memory for reuse.
class BucketOrder {
 public:
  /// Usage: call start(), then count() for every item, then finish_count(), then place() for the
  /// same items in the same order; place() returns the position of the item.
  void start(const Slices& slices) {
    begin_.assign(slices.size() + 1, 0);
    reach_.assign(slices.size(), 0);
  }
  void count(std::uint32_t lo_slice, std::uint32_t hi_slice) noexcept {
    ++begin_[lo_slice + 1];
    reach_[lo_slice] = std::max(reach_[lo_slice], hi_slice);
  }
  void finish_count();
  [[nodiscard]] std::uint32_t place(std::uint32_t lo_slice) noexcept { return next_[lo_slice]++; }

  /// The first position whose box may reach this slice or a later one.
  [[nodiscard]] std::uint32_t first(std::uint32_t slice) const noexcept { return first_[slice]; }
  /// One past the last position whose box begins in this slice or an earlier one.
  [[nodiscard]] std::uint32_t end(std::uint32_t slice) const noexcept { return begin_[slice + 1]; }

 private:
  std::vector<std::uint32_t> begin_;  // first position per slice, then the total
  std::vector<std::uint32_t> reach_;  // per slice: the last slice that its boxes reach
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> next_;
};

}  // namespace tess::collide::serial
