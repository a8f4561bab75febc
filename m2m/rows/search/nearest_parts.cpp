#include "m2m/rows/search/nearest_parts.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

/// The smallest and the largest squared distance between points of two boxes.
struct Range {
  double least, greatest;
};
Range distances(const Aabb& a, const Aabb& b) {
  Range squared{0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double gap = std::max({a.lo[axis] - b.hi[axis], b.lo[axis] - a.hi[axis], 0.0});
    const double span = std::max(a.hi[axis] - b.lo[axis], b.hi[axis] - a.lo[axis]);
    squared.least += gap * gap;
    squared.greatest += span * span;
  }
  return squared;
}

}  // namespace

NearestParts::NearestParts(std::span<const Aabb> boxes, const Aabb& queries) {
  const auto is_empty = [](const Aabb& box) { return box.lo[0] > box.hi[0]; };
  double bound = std::numeric_limits<double>::infinity();
  for (const Aabb& box : boxes)
    if (!is_empty(box)) bound = std::min(bound, distances(box, queries).greatest);
  bound *= 1 + 1e-12;  // for rounding
  for (std::size_t part = 0; part < boxes.size(); ++part) {
    if (is_empty(boxes[part]) || distances(boxes[part], queries).least > bound) continue;
    boxes_.push_back(boxes[part]);
    numbers_.push_back(static_cast<std::int32_t>(part));
  }
}

NearestParts::RankedPart NearestParts::next(const Point& p, const RankedPart& last) const {
  RankedPart best = none;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const RankedPart part{squared_distance(p, boxes_[i]), numbers_[i]};
    if (part > last && part < best) best = part;
  }
  return best;
}

}  // namespace tess::m2m
