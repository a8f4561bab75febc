// A cover stands for many small objects in the broad phase: a few boxes that together contain them,
// with the list of those that each contains. Objects near to each other share a box. The broad
// phase then handles one box instead of some dozens, and the objects of a box without a partner are
// not looked at again.
#pragma once

#include "m2m/mesh_view.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

struct Cover {
  std::vector<Aabb> boxes;
  std::vector<std::uint32_t> first;    ///< per box, and the end: its first position in members
  std::vector<std::uint32_t> members;  ///< objects, by box

  [[nodiscard]] std::span<const std::uint32_t> members_of(std::uint32_t box) const {
    return std::span(members).subspan(first[box], first[box + 1] - first[box]);
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(boxes, first, members);
  }
};

/// The boxes contain each tetrahedron with its search_box(), extended by `reach`.
[[nodiscard]] Cover cover_tets(std::span<const Point> points, std::span<const Tet> tets,
                               double reach = 0);
[[nodiscard]] Cover cover_points(std::span<const Point> points);

/// Sorts numbers of boxes of a cover and removes copies.
void sort_unique_boxes(std::vector<std::uint32_t>& boxes);

}  // namespace tess::m2m
