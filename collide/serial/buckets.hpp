// Boxes in order of slices along one axis: what a sweep needs, without a comparison sort. The slice
// of a coordinate is a monotone function, so of all boxes that may overlap one from lo to hi, the
// lower corners lie in no later slice than hi, and none stands before first(lo). A sweep tests that
// run of neighbours and nothing else. How the slices are chosen affects speed only.
#pragma once

#include "collide/hit.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace tess::collide::serial {

/// Slices of the widest axis of some boxes: monotone in the coordinate.
class Slices {
 public:
  /// About a fourth as many slices as there are items, over the axis on which they spread most. A
  /// sample decides.
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

/// Where each item stands in the order of slices, and where the run of possible partners lies.
/// Scratch: it keeps its memory.
class BucketOrder {
 public:
  /// Puts items in order: afterwards place(i) is the position of the i-th that was counted. Call
  /// count() for all items, then settle(), then place() for the same items in the same order.
  void start(const Slices& slices) {
    begin_.assign(slices.size() + 1, 0);
    reach_.assign(slices.size(), 0);
  }
  void count(std::uint32_t lo_slice, std::uint32_t hi_slice) noexcept {
    ++begin_[lo_slice + 1];
    reach_[lo_slice] = std::max(reach_[lo_slice], hi_slice);
  }
  void settle();
  [[nodiscard]] std::uint32_t place(std::uint32_t lo_slice) noexcept { return next_[lo_slice]++; }

  /// The first position whose box may reach into this slice or beyond.
  [[nodiscard]] std::uint32_t first(std::uint32_t slice) const noexcept { return first_[slice]; }
  /// One past the last position whose box begins in this slice or before.
  [[nodiscard]] std::uint32_t end(std::uint32_t slice) const noexcept { return begin_[slice + 1]; }

 private:
  std::vector<std::uint32_t> begin_;  // by slice; then one past the last
  std::vector<std::uint32_t> reach_;  // the greatest slice that a box of this slice reaches
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> next_;
};

}  // namespace tess::collide::serial
