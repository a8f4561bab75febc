#include "collide/shapes/convex.hpp"

#include "collide/shapes/orientation.hpp"

#include <algorithm>

namespace tess::collide::shapes {
namespace {

using Points = std::span<const Point>;

/// The least and the greatest side of a plane or line on which points lie.
struct SideRange {
  int least = 1, most = -1;
};

template <class Side>
SideRange range_of(Points points, const Side& side) noexcept {
  SideRange range;
  for (const Point& p : points) {
    const int s = side(p);
    range.least = std::min(range.least, s);
    range.most = std::max(range.most, s);
  }
  return range;
}

/// Whether two hulls are on different sides, so that they are apart.
bool parts(const SideRange& a, const SideRange& b) noexcept {
  return a.most < b.least || b.most < a.least;
}

/// Whether two hulls are on different sides, but may meet on the plane. A plane that contains all
/// points (its normal is zero) shows nothing.
bool parts_or_touches(const SideRange& a, const SideRange& b) noexcept {
  const bool all_on_it = a.least == 0 && a.most == 0 && b.least == 0 && b.most == 0;
  return !all_on_it && ((a.most <= 0 && b.least >= 0) || (b.most <= 0 && a.least >= 0));
}

/// Calls visit(from, to) for each edge until it returns true.
template <class Visit>
bool any_edge(Points points, const Visit& visit) noexcept {
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j)
      if (visit(points[i], points[j])) return true;
  return false;
}

/// Calls test(range of a, range of b) for each plane through a face of a hull, and for each plane
/// through an edge of `a` parallel to an edge of `b`, until it returns true.
template <class Test>
bool any_plane(Points a, Points b, const Test& test) noexcept {
  const auto try_plane = [&](const Sides& sides) {
    const auto side = [&](const Point& p) { return sides.of(p); };
    return test(range_of(a, side), range_of(b, side));
  };
  const auto try_faces = [&](Points of) {
    for (std::size_t i = 0; i < of.size(); ++i)
      for (std::size_t j = i + 1; j < of.size(); ++j)
        for (std::size_t k = j + 1; k < of.size(); ++k)
          if (try_plane({of[i], of[j], of[k]})) return true;
    return false;
  };
  return try_faces(a) || try_faces(b) || any_edge(a, [&](const Point& p, const Point& q) {
           return any_edge(b, [&](const Point& r, const Point& s) {
             return try_plane({p, {p, q}, {r, s}});
           });
         });
}

/// The same for lines along edges, within one plane.
bool parted_in_plane(Points a, Points b, Dropped axis) noexcept {
  const auto try_line = [&](const Point& p, const Point& q) {
    const auto side = [&](const Point& r) { return orient2d(p, q, r, axis); };
    return parts(range_of(a, side), range_of(b, side));
  };
  return any_edge(a, try_line) || any_edge(b, try_line);
}

bool parted_on_line(Points a, Points b) noexcept {
  return !overlap(box_around(a), box_around(b), Touching::counts);
}

/// The points of both hulls in one list.
struct Union {
  std::array<Point, 8> points{};
  std::size_t size = 0;

  Union(Points a, Points b) noexcept : size(a.size() + b.size()) {
    std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), points.begin()));
  }
  /// The first point with a property, or `size`.
  template <class Property>
  [[nodiscard]] std::size_t first(const Property& property) const noexcept {
    std::size_t i = 0;
    while (i < size && !property(points[i])) ++i;
    return i;
  }
};

}  // namespace

bool difference_has_volume(Points a, Points b) noexcept {
  const auto edge = [&](std::size_t i) -> Difference {
    const bool of_a = i < a.size() - 1;
    return of_a ? Difference{a[0], a[i + 1]} : Difference{b[0], b[i + 2 - a.size()]};
  };
  const std::size_t n = a.size() + b.size() - 2;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k)
        if (Sides(edge(k).from, edge(i), edge(j)).of(edge(k).to) != 0) return true;
  return false;
}

bool hulls_intersect(Points a, Points b) noexcept {
  const Union all(a, b);
  const Point& p = all.points[0];
  const std::size_t i = all.first([&](const Point& q) { return q != p; });
  if (i == all.size) return true;
  const Point& q = all.points[i];
  const std::size_t j = all.first([&](const Point& r) { return !are_collinear(p, q, r); });
  if (j == all.size) return !parted_on_line(a, b);
  const Point& r = all.points[j];
  const Sides plane(p, q, r);
  if (all.first([&](const Point& s) { return plane.of(s) != 0; }) < all.size)
    return !any_plane(a, b, parts);
  const Dropped axis = orient2d(p, q, r, Dropped::x) != 0   ? Dropped::x
                       : orient2d(p, q, r, Dropped::y) != 0 ? Dropped::y
                                                            : Dropped::z;
  return !parted_in_plane(a, b, axis);
}

bool hulls_cross(Points a, Points b) noexcept {
  return difference_has_volume(a, b) && !any_plane(a, b, parts_or_touches);
}

}  // namespace tess::collide::shapes
