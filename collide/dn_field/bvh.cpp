#include "collide/dn_field/bvh.hpp"

#include "collide/dn_field/triangle_distance.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace tess::dn {
namespace {
constexpr std::uint32_t leaf_size = 4;
constexpr double opening_ratio = 2.0;  // dipole error at most a few per cent of the cluster's share
constexpr double undecided_half_width = 0.2;  // |w - 1/2| below it: ask again without approximation
constexpr std::size_t max_depth = 64;         // median splits: log2 of the number of triangles
}  // namespace

Bvh::Bvh(const Surface& surface) {
  const auto n = surface.triangles.size();
  corners_.resize(n);
  order_.resize(n);
  normals_.resize(n);
  std::iota(order_.begin(), order_.end(), 0U);
  for (std::size_t t = 0; t < n; ++t) {
    corners_[t] = surface.corners(t);
    const auto& [a, b, c] = corners_[t];
    normals_[t] = direction(cross(b - a, c - a));
  }
  nodes_.reserve(n);
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(n));
  auto sorted = corners_;
  for (std::size_t i = 0; i < n; ++i) sorted[i] = corners_[order_[i]];
  corners_ = std::move(sorted);
}

void Bvh::summarise(Node& node, std::uint32_t first, std::uint32_t last) const {
  double area = 0;
  Vec3 centre, plain;
  for (std::uint32_t i = first; i < last; ++i) {
    const auto& [a, b, c] = corners_[order_[i]];
    for (const Vec3 p : {a, b, c}) node.box.extend(p);
    const Vec3 area_normal = 0.5 * cross(b - a, c - a);
    node.area_normal += area_normal;
    area += norm(area_normal);
    centre += norm(area_normal) / 3 * (a + b + c);
  }
  node.centre = area > 0 ? (1 / area) * centre : node.box.centre();
  for (std::uint32_t i = first; i < last; ++i)
    for (const Vec3 p : corners_[order_[i]])
      node.radius = std::max(node.radius, norm(p - node.centre));
}

void Bvh::build(std::uint32_t node, std::uint32_t first, std::uint32_t last) {
  Node made;
  summarise(made, first, last);
  if (last - first <= leaf_size) {
    made.first = first;
    made.count = last - first;
    nodes_[node] = made;
    return;
  }
  const Vec3 size = made.box.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = first + (last - first) / 2;
  const auto key = [&](std::uint32_t t) {
    const auto& [a, b, c] = corners_[t];
    return component(a, axis) + component(b, axis) + component(c, axis);
  };
  std::nth_element(
      order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](auto a, auto b) {
        return std::pair(key(a), a) < std::pair(key(b), b);
      });
  made.first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = made;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(made.first, first, middle);
  build(made.first + 1, middle, last);
}

ClosestPoint Bvh::closest(Vec3 p, double limit2) const {
  struct Pending {
    std::uint32_t node;
    double distance2;
  };
  std::array<Pending, max_depth> stack;
  std::size_t height = 0;
  ClosestPoint best;
  double bound = limit2;
  stack[height++] = {0, nodes_[0].box.distance2(p)};
  while (height > 0) {
    const Pending top = stack[--height];
    if (top.distance2 > bound) continue;
    const Node& node = nodes_[top.node];
    if (node.count == 0) {
      Pending near{node.first, nodes_[node.first].box.distance2(p)};
      Pending far{node.first + 1, nodes_[node.first + 1].box.distance2(p)};
      if (far.distance2 < near.distance2) std::swap(near, far);
      if (far.distance2 <= bound) stack[height++] = far;
      if (near.distance2 <= bound) stack[height++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Vec3 q = closest_on_triangle(p, corners_[i]);
      const double distance2 = dot(q - p, q - p);
      if (distance2 <= bound) {
        bound = distance2;
        best = {distance2, q, order_[i]};
      }
    }
  }
  return best;
}

double Bvh::winding_number(Vec3 p, double accuracy) const {
  std::array<std::uint32_t, max_depth> stack;
  std::size_t height = 0;
  stack[height++] = 0;
  double angle = 0;
  while (height > 0) {
    const Node& node = nodes_[stack[--height]];
    const Vec3 to = node.centre - p;
    const double distance2 = dot(to, to), reach = accuracy * node.radius;
    if (accuracy > 0 && distance2 > reach * reach) {
      angle += dot(to, node.area_normal) / (distance2 * std::sqrt(distance2));
    } else if (node.count == 0) {
      stack[height++] = node.first;
      stack[height++] = node.first + 1;
    } else {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
        angle += solid_angle(p, corners_[i]);
    }
  }
  return angle / (4 * std::numbers::pi);
}

bool Bvh::is_inside(Vec3 p) const {
  const double w = winding_number(p, opening_ratio);
  return std::abs(w - 0.5) > undecided_half_width ? w > 0.5 : winding_number(p, 0) > 0.5;
}

}  // namespace tess::dn
