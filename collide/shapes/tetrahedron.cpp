#include "collide/tetrahedron.hpp"

#include "collide/shapes/convex.hpp"
#include "collide/shapes/orientation.hpp"

#include <algorithm>

namespace tess::collide {
namespace {

using shapes::Sides;
using Points = std::span<const Point>;

enum class Place { outside, on_surface, inside };

/// The face opposite to a corner.
Triangle face(const Tetrahedron& t, std::size_t opposite) noexcept {
  const auto& c = t.corners;
  return {{c[(opposite + 1) % 4], c[(opposite + 2) % 4], c[(opposite + 3) % 4]}};
}

/// Where a point is. One without volume has no inside: the answer is outside.
Place place_in(const Tetrahedron& t, const Point& p) noexcept {
  Place place = Place::inside;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& c = t.corners;
    const Sides plane(c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4]);
    const int side = plane.of(p) * plane.of(c[i]);
    if (side < 0 || (side == 0 && plane.of(c[i]) == 0)) return Place::outside;
    if (side == 0) place = Place::on_surface;
  }
  return place;
}

/// Whether all points are strictly beyond one face. This is the fast answer for most pairs.
bool are_beyond_a_face(Points points, const Tetrahedron& t) noexcept {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& c = t.corners;
    const Sides plane(c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4]);
    const int inner = plane.certain(c[i]);
    if (inner != 0 && std::all_of(points.begin(), points.end(),
                                  [&](const Point& p) { return plane.certain(p) == -inner; }))
      return true;
  }
  return false;
}

/// A body that has no corner inside the tetrahedron intersects it only through a face.
template <class Test>
bool any_face(const Tetrahedron& t, const Test& test) noexcept {
  for (std::size_t i = 0; i < 4; ++i)
    if (test(face(t, i))) return true;
  return false;
}

}  // namespace

bool intersect(const Tetrahedron& a, const Point& b, Touching touching) noexcept {
  const Place place = place_in(a, b);
  if (place != Place::outside) return place == Place::inside || touching == Touching::counts;
  if (touching == Touching::does_not_count || are_beyond_a_face({&b, 1}, a)) return false;
  return shapes::hulls_intersect(a.corners, {&b, 1});  // without volume
}

bool intersect(const Tetrahedron& a, const Segment& b, Touching touching) noexcept {
  const std::array ends{b.from, b.to};
  if (are_beyond_a_face(ends, a)) return false;
  return touching == Touching::counts ? shapes::hulls_intersect(a.corners, ends)
                                      : shapes::hulls_cross(a.corners, ends);
}

bool intersect(const Tetrahedron& a, const Triangle& b, Touching touching) noexcept {
  if (are_beyond_a_face(b.corners, a)) return false;
  if (touching == Touching::does_not_count) return shapes::hulls_cross(a.corners, b.corners);
  return place_in(a, b.corners[0]) != Place::outside ||
         any_face(a, [&](const Triangle& f) { return intersect(f, b, touching); });
}

bool intersect(const Tetrahedron& a, const Tetrahedron& b, Touching touching) noexcept {
  if (are_beyond_a_face(b.corners, a) || are_beyond_a_face(a.corners, b)) return false;
  if (touching == Touching::does_not_count) return shapes::hulls_cross(a.corners, b.corners);
  return place_in(a, b.corners[0]) != Place::outside ||
         place_in(b, a.corners[0]) != Place::outside || any_face(a, [&](const Triangle& f) {
           return any_face(b, [&](const Triangle& g) { return intersect(f, g, touching); });
         });
}

bool intersect(const Tetrahedron& a, const Sphere& b, Touching touching) noexcept {
  const Place place = place_in(a, b.centre);
  if (place == Place::inside || (place == Place::on_surface && touching == Touching::counts))
    return true;
  return any_face(a, [&](const Triangle& f) { return intersect(b, f, touching); });
}

}  // namespace tess::collide
