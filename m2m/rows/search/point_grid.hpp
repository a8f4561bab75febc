// Points sorted into cells, so that those in a box are found quickly. A search goes over the source
// tetrahedra once and asks for the points in the box of each: neither side needs a tree, and no
// list of candidates is stored.
#pragma once

#include "m2m/rows/search/cells.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class PointGrid {
 public:
  explicit PointGrid(std::span<const Point> points);

  /// The points in the order of the grid, and their numbers in the list given.
  [[nodiscard]] std::span<const Point> points() const { return points_; }
  [[nodiscard]] std::span<const std::uint32_t> numbers() const { return numbers_; }

  [[nodiscard]] bool is_in(std::int32_t position, const Aabb& box) const {
    const Point& p = points_[static_cast<std::size_t>(position)];
    return !((p[0] < box.lo[0]) | (p[0] > box.hi[0]) | (p[1] < box.lo[1]) | (p[1] > box.hi[1]) |
             (p[2] < box.lo[2]) | (p[2] > box.hi[2]));
  }
  /// Lists the positions of the points in the closed box, in the order of visit_rows(), until `out`
  /// is full. Returns how many it lists, or one more if there are more.
  [[nodiscard]] std::size_t list_in(const Aabb& box, std::span<std::uint32_t> out) const {
    std::size_t n = 0;
    visit_rows(box, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t at = first; at < last; ++at) {
        if (!is_in(static_cast<std::int32_t>(at), box)) continue;
        if (n == out.size()) {
          ++n;
          return false;
        }
        out[n++] = at;
      }
      return true;
    });
    return n;
  }

  /// Calls visit(position, end) for the rows of the cells that the box touches, until it returns
  /// false. Returns whether it never did.
  template <class Visit>
  bool visit_rows(const Aabb& box, const Visit& visit) const {
    std::array<std::int32_t, 3> low{}, high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box.hi[axis] < around_.lo[axis] || box.lo[axis] > around_.hi[axis]) return true;
      low[axis] = cells_.along(axis, box.lo[axis]);
      high[axis] = cells_.along(axis, box.hi[axis]);
    }
    for (std::int32_t z = low[2]; z <= high[2]; ++z)
      for (std::int32_t y = low[1]; y <= high[1]; ++y)
        if (!visit(first_[cells_.number(low[0], y, z)], first_[cells_.number(high[0], y, z) + 1]))
          return false;
    return true;
  }

 private:
  Aabb around_;
  Cells cells_;
  std::vector<std::uint32_t> first_;  // per cell, and the end: position of its first point
  std::vector<Point> points_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace tess::m2m
