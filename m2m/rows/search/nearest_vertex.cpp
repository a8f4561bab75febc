#include "m2m/rows/search/nearest_vertex.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace tess::m2m {
namespace {

constexpr std::int32_t points_of_leaf = 16;

std::size_t at(std::int32_t index) {
  return static_cast<std::size_t>(index);
}

std::vector<std::int32_t> all(std::size_t n) {
  std::vector<std::int32_t> indices(n);
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

std::size_t longest_axis(const Aabb& box) {
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (box.hi[axis] - box.lo[axis] > box.hi[longest] - box.lo[longest]) longest = axis;
  return longest;
}

}  // namespace

NearestVertex::NearestVertex(std::span<const Point> points, std::span<const GlobalId> ids)
    : NearestVertex(points, ids, all(points.size())) {}

NearestVertex::NearestVertex(std::span<const Point> points, std::span<const GlobalId> ids,
                             std::vector<std::int32_t> vertices)
    : points_(points.begin(), points.end()), vertices_(std::move(vertices)) {
  if (!vertices_.empty()) build(0, static_cast<std::int32_t>(vertices_.size()));
  for (std::size_t i = 0; i < vertices_.size(); ++i) points_[i] = points[at(vertices_[i])];
  points_.resize(vertices_.size());
  for (const std::int32_t v : vertices_) ids_.push_back(ids.empty() ? v : ids[at(v)]);
}

/// Sorts only vertices_; the constructor reorders points_ at the end.
void NearestVertex::build(std::int32_t first, std::int32_t last) {
  const std::size_t self = nodes_.size();
  const auto begin = vertices_.begin() + first, end = vertices_.begin() + last;
  Aabb box = collide::box_of(points_[at(*begin)]);
  for (auto v = begin; v != end; ++v) grow(box, points_[at(*v)]);
  nodes_.push_back({box, first, last});
  if (last - first <= points_of_leaf) return;
  const std::size_t axis = longest_axis(box);
  const std::int32_t middle = first + (last - first) / 2;
  std::nth_element(begin, vertices_.begin() + middle, end, [&](std::int32_t a, std::int32_t b) {
    return points_[at(a)][axis] < points_[at(b)][axis];
  });
  build(first, middle);
  nodes_[self].second = static_cast<std::int32_t>(nodes_.size());
  build(middle, last);
}

template <class See>
void NearestVertex::visit(const Point& p, const double& squared_reach, const See& see) const {
  if (nodes_.empty()) return;
  struct Pending {
    std::int32_t node;
    double squared_distance;
  };
  std::array<Pending, 64> stack;  // each level halves the range, so the depth is at most 32
  std::size_t n = 0;
  stack[n++] = {0, squared_distance(p, nodes_[0].box)};
  while (n > 0) {
    Pending next = stack[--n];
    while (next.squared_distance <= squared_reach) {
      const Node& node = nodes_[at(next.node)];
      if (node.second < 0) {
        for (std::int32_t i = node.first; i < node.last; ++i)
          see(at(i), squared_distance(p, points_[at(i)]));
        break;
      }
      Pending near{next.node + 1, squared_distance(p, nodes_[at(next.node + 1)].box)};
      Pending far{node.second, squared_distance(p, nodes_[at(node.second)].box)};
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      stack[n++] = far;
      next = near;
    }
  }
}

NearestVertex::Answer NearestVertex::find(const Point& p, double squared_reach) const {
  Answer best{-1, squared_reach};
  GlobalId best_id = std::numeric_limits<GlobalId>::max();
  visit(p, best.squared_distance, [&](std::size_t i, double squared) {
    const bool first = ids_[i] < best_id;
    if (squared < best.squared_distance || (squared == best.squared_distance && first)) {
      best = {vertices_[i], squared};
      best_id = ids_[i];
    }
  });
  return best;
}

void NearestVertex::find(const Point& p, std::size_t n, double squared_reach,
                         std::vector<Neighbour>& out) const {
  out.clear();  // a heap, the farthest first
  visit(p, squared_reach, [&](std::size_t i, double squared) {
    if (squared > squared_reach) return;
    const Neighbour mine{squared, ids_[i], vertices_[i]};
    if (out.size() == n) {
      if (!(mine < out.front())) return;
      std::pop_heap(out.begin(), out.end());
      out.back() = mine;
    } else {
      out.push_back(mine);
    }
    std::push_heap(out.begin(), out.end());
    if (out.size() == n) squared_reach = out.front().squared_distance;
  });
  std::sort_heap(out.begin(), out.end());
}

}  // namespace tess::m2m
