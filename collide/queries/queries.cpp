#include "collide/queries.hpp"

#include "runtime/core/error.hpp"

#include <limits>

namespace tess::collide::detail {
namespace {

bool is_finite(const Point& p) noexcept {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

std::string in_words(const Point& p) {
  return text('(', p[0], ", ", p[1], ", ", p[2], ')');
}

}  // namespace

void refuse_object(std::size_t position, const Aabb& box) {
  fail(ErrorCode::bad_value, "object ", position, " of the index has the box ", in_words(box.lo),
       " to ", in_words(box.hi), "; repair it: its coordinates must be finite, and lo <= hi");
}

void check_count(std::size_t n) {
  if (n >= std::numeric_limits<std::uint32_t>::max())
    fail(ErrorCode::bad_value, "an index of ", n,
         " objects; it holds less than 2^32: split the objects over several");
}

void check_point(const Point& p) {
  if (!is_finite(p))
    fail(ErrorCode::bad_value, "a query at the point ", in_words(p), "; it must be finite");
}

void check_radius(double radius) {
  if (!(radius >= 0) || !std::isfinite(radius))
    fail(ErrorCode::bad_value, "a query within a radius of ", radius,
         "; it must be finite and not negative");
}

void check_ray(const Ray& ray) {
  if (!is_finite(ray.from) || !is_finite(ray.direction) || ray.direction == Point{})
    fail(ErrorCode::bad_value, "a ray from ", in_words(ray.from), " in the direction ",
         in_words(ray.direction), "; both must be finite, and the direction not zero");
}

RayToBox::RayToBox(const Ray& ray) noexcept : ray_(ray) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double size = std::abs(ray.direction[k]);
    // The reciprocal of any other component is not accurate; its axis rules out no box.
    const bool is_usable = size > 1e-300 && size < 1e300;
    inverse_[k] = is_usable ? 1 / ray.direction[k] : 0;
  }
}

double RayToBox::entry(const Aabb& box) const noexcept {
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double slack = 1e-14, least = 1e-300;  // above three roundings, and underflow
  double first = 0, last = largest;
  for (std::size_t k = 0; k < 3; ++k) {
    if (ray_.direction[k] == 0) {
      if (ray_.from[k] < box.lo[k] || ray_.from[k] > box.hi[k]) return HUGE_VAL;
    }
    if (inverse_[k] == 0) continue;
    const double to_lo = (box.lo[k] - ray_.from[k]) * inverse_[k];
    const double to_hi = (box.hi[k] - ray_.from[k]) * inverse_[k];
    const double near = inverse_[k] > 0 ? to_lo : to_hi, far = inverse_[k] > 0 ? to_hi : to_lo;
    first = std::max(first, near - std::abs(near) * slack - least);
    last = std::min(last, far + std::abs(far) * slack + least);
  }
  first = std::min(first, largest);  // an overflow is far away, and not a miss
  return first <= last ? first : HUGE_VAL;
}

BoxTree<Aabb, 3> tree_over(std::span<const Aabb> boxes) {
  using Tree = BoxTree<Aabb, 3>;
  if (boxes.empty()) return {};
  Aabb all = boxes[0];
  for (const Aabb& box : boxes) all = merged(all, box);
  // Halves do not overflow. One scale for all axes keeps the proportions.
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, all.hi[k] / 2 - all.lo[k] / 2);
  const double scale = size > 1e-300 ? 1 / size : 0;
  std::vector<Tree::Centre> centres(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    centres[i].object = static_cast<std::uint32_t>(i);
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = all.lo[k] / 2;
      const double middle = (boxes[i].lo[k] / 2 - low) / 2 + (boxes[i].hi[k] / 2 - low) / 2;
      centres[i].at[k] = static_cast<float>(middle * scale);
    }
  }
  Tree tree(std::move(centres));
  const std::span<Tree::Node> nodes = tree.nodes();
  for (std::size_t at = nodes.size(); at-- > 0;) {
    Tree::Node& node = nodes[at];
    node.box = node.count != 0 ? boxes[tree.object(node.first)] : nodes[node.first].box;
    if (node.count == 0) node.box = merged(node.box, nodes[node.first + 1].box);
    Tree::each_place(node,
                     [&](std::uint32_t i) { node.box = merged(node.box, boxes[tree.object(i)]); });
  }
  return tree;
}

}  // namespace tess::collide::detail
