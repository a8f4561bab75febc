// Enumerates the pairs of a tetrahedron and a point in its box. It goes over the tetrahedra once,
// 64 at a time, and over the points that are in the box around these.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/search/box_block.hpp"
#include "m2m/rows/search/point_grid.hpp"
#include "runtime/core/algorithm.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class NearPairs {
 public:
  /// Boxes are the padded ones (locate.hpp), extended by `reach`.
  NearPairs(const MeshView& mesh, std::span<const Point> points, double reach)
      : mesh_(mesh), grid_(points), reach_(reach), near_(points.size()) {}

  /// The order of the points. Positions are those in its list.
  [[nodiscard]] const PointGrid& grid() const { return grid_; }

  /// Calls found(tet, position, holds) for some tetrahedra, members of a box of a cover, and the
  /// points that may be in their boxes; `holds` says which are. (A branch here would be expensive:
  /// it is not predictable.) `around` contains the boxes.
  template <class Found>
  void visit(const Aabb& around, std::span<const std::uint32_t> tets, const Found& found) {
    std::array<std::uint32_t, few> some;
    const std::size_t n_in = grid_.list_in(around, some);
    if (n_in == 0) return;
    for (std::size_t first = 0; first < tets.size(); first += BoxBlock::capacity) {
      const auto members = tets.subspan(first, std::min(BoxBlock::capacity, tets.size() - first));
      block_.load(mesh_.points, mesh_.tets, members, reach_);
      if (n_in <= few) {
        for (const std::uint32_t at : std::span(some).first(n_in))
          for (std::uint64_t boxes = block_.holding(grid_.points()[at]); boxes != 0;
               boxes &= boxes - 1)
            found(members[static_cast<std::size_t>(std::countr_zero(boxes))], at, true);
        continue;
      }
      block_.make_slabs();
      list_near();
      for (const Near& near : std::span(near_).first(n_near_)) {
        const Point& p = grid_.points()[near.at];
        for (std::uint64_t boxes = near.boxes; boxes != 0; boxes &= boxes - 1) {
          const auto box = static_cast<std::size_t>(std::countr_zero(boxes));
          found(members[box], near.at, block_.holds(box, p));
        }
      }
    }
  }

 private:
  /// So many points are compared with all boxes of a block.
  static constexpr std::size_t few = 8;
  /// A point that some boxes of the block may hold, a bit per box.
  struct Near {
    std::uint64_t boxes;
    std::uint32_t at;
  };

  /// Separate from the loop over bits, and without branches: whether a point is near is not
  /// predictable.
  void list_near() {
    n_near_ = 0;
    grid_.visit_rows(block_.around(), [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t at = first; at < last; ++at) {
        const std::uint64_t boxes = block_.maybe_holding(grid_.points()[at]);
        near_[n_near_] = {boxes, at};
        n_near_ += boxes != 0 ? 1U : 0U;
      }
      return true;
    });
  }

  const MeshView& mesh_;
  PointGrid grid_;
  double reach_;
  BoxBlock block_;
  std::vector<Near> near_;  // the first n_near_ are near the block
  std::size_t n_near_ = 0;
};

}  // namespace tess::m2m
