// Sorts the boxes of a voxel into slices along one axis, for a sweep, without a comparison sort.
// The slice is a monotone function of the coordinate. So if a box may overlap one that reaches from
// lo to hi, its lower corner lies in the slice of hi or an earlier one, and its position is not
// before first(slice of lo). The sweep tests only this range of positions. The choice of the slices
// affects only the speed.
#pragma once

#include "collide/box.hpp"
#include "collide/problem/entry.hpp"

#include <limits>
#include <span>
#include <vector>

namespace tess::collide::search {

template <class Real, std::size_t D>
class Slices {
 public:
  /// Sorts the boxes: four of them per slice, along the axis on which a sample spreads most.
  void sort(const Box<Real, D>* boxes, std::span<const Entry> entries) {
    choose(boxes, entries);
    begin_.assign(n_ + 2, 0);
    slice_.resize(entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::uint32_t slice = of(boxes[object_of(entries[i])].lo[axis_]);
      slice_[i] = slice;
      ++begin_[slice + 2];
    }
    // begin_[s + 1] is where the next box of slice s goes, and finally where it ends.
    for (std::size_t s = 2; s < n_ + 2; ++s) begin_[s] += begin_[s - 1];
  }
  /// The position of box i, called once per box in the order of the entries.
  [[nodiscard]] std::uint32_t place(std::size_t i) noexcept { return begin_[slice_[i] + 1]++; }

  /// Call it after the boxes are placed, before first(), with their upper ends by position.
  void find_firsts(const Real* upper_ends) {
    first_.resize(n_);
    reach_.resize(n_);
    std::uint32_t at = 0;
    for (std::uint32_t s = 0; s < n_; ++s) {
      Real highest = -std::numeric_limits<Real>::infinity();
      for (std::uint32_t i = begin_[s]; i < begin_[s + 1]; ++i)
        highest = std::max(highest, upper_ends[i]);
      reach_[s] = of(highest);
      while (at < s && (begin_[at] == begin_[at + 1] || reach_[at] < s)) ++at;
      first_[s] = begin_[at];
    }
  }
  /// The first position whose box may reach a box with this lower end.
  [[nodiscard]] std::uint32_t first(const std::array<Real, D>& lo) const noexcept {
    return first_[of(lo[axis_])];
  }
  /// One past the last position whose box may reach a box with this upper end.
  [[nodiscard]] std::uint32_t end(const std::array<Real, D>& hi) const noexcept {
    return end(hi[axis_]);
  }
  [[nodiscard]] std::uint32_t end(Real hi) const noexcept { return begin_[of(hi) + 1]; }
  [[nodiscard]] std::size_t axis() const noexcept { return axis_; }

 private:
  void choose(const Box<Real, D>* boxes, std::span<const Entry> entries) {
    constexpr std::size_t n_sample = 16;
    const std::size_t stride = entries.size() / n_sample + 1;
    Box<Real, D> all = no_box<Real, D>();
    std::array<Real, D> extents{};
    for (std::size_t i = 0; i < entries.size(); i += stride) {
      const Box<Real, D>& box = boxes[object_of(entries[i])];
      for (std::size_t k = 0; k < D; ++k) {
        all.lo[k] = std::min(all.lo[k], box.lo[k]);
        all.hi[k] = std::max(all.hi[k], box.lo[k]);
        extents[k] += box.hi[k] - box.lo[k];
      }
    }
    Real best = -1;
    for (std::size_t k = 0; k < D; ++k) {
      const Real spread = all.hi[k] - all.lo[k];
      const Real beside = spread / (extents[k] + spread / n_sample);  // large: few partners
      if (beside > best) {
        best = beside;
        axis_ = k;
      }
    }
    n_ = static_cast<std::uint32_t>(std::clamp<std::size_t>(entries.size() / 4, 1, 1 << 16));
    lo_ = all.lo[axis_];
    per_length_ = static_cast<Real>(n_) / (all.hi[axis_] - all.lo[axis_]);
    if (!std::isfinite(per_length_)) {  // no extent: one slice
      n_ = 1;
      per_length_ = 0;
    }
  }
  [[nodiscard]] std::uint32_t of(Real x) const noexcept {
    const Real at = (x - lo_) * per_length_;
    const Real above = at > 0 ? at : Real{0};
    const Real last = static_cast<Real>(n_ - 1);
    return static_cast<std::uint32_t>(above < last ? above : last);
  }

  std::size_t axis_ = 0;
  std::uint32_t n_ = 1;
  Real lo_ = 0, per_length_ = 0;
  std::vector<std::uint32_t> slice_;  // per box
  std::vector<std::uint32_t> begin_;
  std::vector<std::uint32_t> reach_;  // per slice: the last one that its boxes reach
  std::vector<std::uint32_t> first_;
};

}  // namespace tess::collide::search
