#include "collide/ray.hpp"

#include "collide/shapes/determinant.hpp"
#include "collide/shapes/vector.hpp"

#include <algorithm>
#include <limits>

namespace tess::collide {
namespace {

using shapes::ratio;
using shapes::sign_of;
using shapes::way;

constexpr Point zero{};

}  // namespace

std::optional<double> hit(const Aabb& object, const Ray& ray) noexcept {
  // The ray enters the slab of an axis at (near - from) / direction, and leaves it at `far`.
  struct Slab {
    double near, far, from, direction;
  };
  std::array<Slab, 3> slabs{};
  std::size_t n = 0;
  double at = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double from = ray.from[k], d = ray.direction[k];
    if (d == 0) {
      if (from < object.lo[k] || from > object.hi[k]) return std::nullopt;
      continue;
    }
    const Slab slab = d > 0 ? Slab{object.lo[k], object.hi[k], from, d}
                            : Slab{-object.hi[k], -object.lo[k], -from, -d};
    if (slab.far < slab.from) return std::nullopt;
    double enters = (slab.near - slab.from) / slab.direction;
    if (enters > std::numeric_limits<double>::max())  // the difference may have overflowed
      enters = ratio([&](auto number) { return number(slab.near) - number(slab.from); },
                     [&](auto number) { return number(slab.direction); });
    at = std::max(at, enters);
    slabs[n++] = slab;
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const int sign = sign_of([&](auto number) {
        const auto enters =
            (number(slabs[i].near) - number(slabs[i].from)) * number(slabs[j].direction);
        const auto leaves =
            (number(slabs[j].far) - number(slabs[j].from)) * number(slabs[i].direction);
        return leaves - enters;
      });
      if (sign < 0) return std::nullopt;
    }
  return at;
}

std::optional<double> hit(const Triangle& object, const Ray& ray) noexcept {
  const auto& [a, b, c] = object.corners;
  const Point& o = ray.from;
  const shapes::Difference direction{zero, ray.direction};
  // On which side the ray's line passes each edge. The three volumes add up to direction · normal.
  const auto passes = [&](const Point& from, const Point& to) {
    return shapes::Sides(o, direction, {o, from}).of(to);
  };
  const int ab = passes(a, b), bc = passes(b, c);
  if (ab * bc < 0) return std::nullopt;
  const int ca = passes(c, a);
  if (ab * ca < 0 || bc * ca < 0) return std::nullopt;
  const int turn = ab != 0 ? ab : bc != 0 ? bc : ca;
  if (turn == 0) return std::nullopt;
  const int side = shapes::orient3d(a, b, c, o);
  if (side == turn) return std::nullopt;  // the plane is behind
  if (side == 0) return 0;
  return ratio(
      [&](auto number) {
        return determinant(number, {a, b}, {a, c}, {o, a});
      },
      [&](auto number) {
        return determinant(number, {a, b}, {a, c}, direction);
      });
}

std::optional<double> hit(const Sphere& object, const Ray& ray) noexcept {
  const auto to_centre = [&](auto number) { return way(number, ray.from, object.centre); };
  const auto outside2 = [&](auto number) {
    const auto w = to_centre(number);
    return dot(w, w) - number(object.radius) * number(object.radius);
  };
  const auto ahead = [&](auto number) {
    return dot(vector(number, ray.direction), to_centre(number));
  };
  // A quarter of the discriminant of |from + t direction - centre|² = radius².
  const auto discriminant = [&](auto number) {
    const auto d = vector(number, ray.direction);
    const auto off = cross(d, to_centre(number));
    return number(object.radius) * number(object.radius) * dot(d, d) - dot(off, off);
  };
  if (sign_of(outside2) <= 0) return 0;
  if (sign_of(ahead) <= 0 || sign_of(discriminant) < 0) return std::nullopt;
  // outside2 / (ahead + sqrt(discriminant)), of ratios that stay in the range of a double.
  return ratio(outside2, ahead) /
         (1 + std::sqrt(ratio(discriminant, [&](auto n) { return ahead(n) * ahead(n); })));
}

std::optional<double> hit(const Tetrahedron& object, const Ray& ray) noexcept {
  if (intersect(object, ray.from, Touching::counts)) return 0;
  std::optional<double> first;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& c = object.corners;
    const auto at = hit(Triangle{{c[i], c[(i + 1) % 4], c[(i + 2) % 4]}}, ray);
    if (at && (!first || *at < *first)) first = at;
  }
  return first;
}

}  // namespace tess::collide
