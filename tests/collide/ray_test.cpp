#include "collide/ray.hpp"

#include "tests/collide/shapes/oracle.hpp"
#include "tests/collide/shapes/rational.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

/// Where a ray meets the plane of a triangle, if that is in the triangle: barycentric coordinates.
std::optional<Rational> exact_hit(const Triangle& t, const Ray& ray) {
  const Exact a = exact(t.corners[0]), o = exact(ray.from), d = exact(ray.direction);
  const Exact u = exact(t.corners[1]) - a, v = exact(t.corners[2]) - a, w = o - a;
  const Exact normal = cross(u, v);
  const Rational speed = dot(normal, d);
  if (speed == 0) return std::nullopt;
  const Rational at = -dot(normal, w) / speed;
  const Exact x = w + at * d;
  const Rational area2 = dot(normal, normal);
  const Rational beta = dot(cross(x, v), normal) / area2, gamma = dot(cross(u, x), normal) / area2;
  if (at < 0 || beta < 0 || gamma < 0 || beta + gamma > 1) return std::nullopt;
  return at;
}

std::optional<Rational> exact_hit(const Aabb& box, const Ray& ray) {
  Rational first = 0;
  std::optional<Rational> last;
  for (std::size_t k = 0; k < 3; ++k) {
    const Rational o(ray.from[k]), d(ray.direction[k]), lo(box.lo[k]), hi(box.hi[k]);
    if (d == 0) {
      if (o < lo || o > hi) return std::nullopt;
      continue;
    }
    Rational in = (lo - o) / d, out = (hi - o) / d;
    if (in > out) std::swap(in, out);
    first = std::max(first, in);
    last = last ? std::min(*last, out) : out;
  }
  return first <= *last ? std::optional(first) : std::nullopt;
}

template <class Object>
bool agree(const Object& object, const Ray& ray) {
  const auto found = hit(object, ray);
  const auto expected = exact_hit(object, ray);
  if (found.has_value() != expected.has_value()) return false;
  return !found || abs(Rational(*found) - *expected) <= *expected * Rational(0x1p-42);
}

bool agree(const Sphere& ball, const Ray& ray) {
  const Exact d = exact(ray.direction), w = exact(ball.centre) - exact(ray.from);
  const Rational r(ball.radius), speed2 = dot(d, d), ahead = dot(d, w), outside = dot(w, w) - r * r;
  const bool expected = outside <= 0 || (ahead > 0 && ahead * ahead >= speed2 * outside);
  const auto found = hit(ball, ray);
  if (found.has_value() != expected) return false;
  if (!found || outside <= 0) return !found || *found == 0;
  if (!std::isfinite(*found)) return false;
  const auto is_before = [&](const Rational& t) {
    return t * speed2 <= ahead && t * (t * speed2 - 2 * ahead) + outside >= 0;
  };
  const Rational t(*found);
  return is_before(t * Rational(1 - 0x1p-42)) && !is_before(t * Rational(1 + 0x1p-42));
}

/// Scaled by powers of two: the shape's, and another for the direction. The answer follows.
Point scaled(Point p, int power, double offset = 0) {
  for (double& x : p) x = std::ldexp(x, power) + offset;
  return p;
}
template <class Shape>
Shape scaled(Shape shape, int power, double offset = 0) {
  for (Point& p : shape.corners) p = scaled(p, power, offset);
  return shape;
}
struct Powers {
  explicit Powers(SmallPoints& random)
      : place(int(random.below(1001)) - 500), speed(int(random.below(1001)) - 500) {}
  int place, speed;
};
Ray scaled(const Ray& ray, const Powers& powers) {
  return {scaled(ray.from, powers.place), scaled(ray.direction, powers.speed)};
}

}  // namespace

TEST_CASE("rays meet triangles and boxes as rational numbers say, at edges and corners too",
          "[collide][shapes]") {
  SmallPoints random(1);
  int n_hits = 0, n_box_hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const int size = 3 + i % 4;
    Triangle t{random.points<3>(size)};
    Ray ray{random.point(size), random.point(size)};
    if (i % 3 == 0)  // through a corner or the middle of an edge
      for (std::size_t k = 0; k < 3; ++k)
        ray.direction[k] = t.corners[0][k] + (i % 2 == 0 ? t.corners[0][k] : t.corners[1][k]);
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] -= (i % 3 == 0 ? 2 : 1) * ray.from[k];
    if (i % 7 == 0)
      for (double& x : ray.direction) x *= 0.1;
    if (ray.direction == Point{}) continue;
    INFO(i);
    REQUIRE(agree(t, ray));
    const Aabb box = merged(box_of(random.point(size)), box_of(t.corners[1]));
    REQUIRE(agree(box, ray));
    const Powers powers(random);
    REQUIRE(agree(scaled(t, powers.place), scaled(ray, powers)));
    REQUIRE(agree(Aabb{scaled(box.lo, powers.place), scaled(box.hi, powers.place)},
                  scaled(ray, powers)));
    n_hits += hit(t, ray) ? 1 : 0;
    n_box_hits += hit(box, ray) ? 1 : 0;
    if (i % 7 == 0) continue;
    for (const auto& [power, offset] : {std::pair{-30, 0.0}, {30, 0.0}, {0, 1e12}}) {
      const Ray other{scaled(ray.from, power, offset), scaled(ray.direction, power)};
      REQUIRE(hit(scaled(t, power, offset), other) == hit(t, ray));
    }
  }
  CHECK(n_hits > 500);
  CHECK(n_box_hits > 500);
}

// The way to a box is longer than the largest double.
TEST_CASE("a ray meets boxes at the other end of the range of coordinates in their order",
          "[collide][shapes]") {
  for (const double side : {1.0, -1.0})
    for (const double speed : {1.0, 1e300, 1.7e308}) {
      const Ray ray{{-1.2e308 * side, 0, 0}, {speed * side, 0, 0}};
      CAPTURE(side, speed);
      double last = 0;
      for (const double near : {1.1e308, 1.2e308, 1.6e308}) {
        const double x = near * side, y = (near + 1e307) * side;
        const Aabb box{{std::min(x, y), -1, -1}, {std::max(x, y), 1, 1}};
        const auto at = hit(box, ray);
        REQUIRE(at);
        if (speed == 1) {
          CHECK(*at > 1.7e308);  // infinite
          continue;
        }
        CHECK(*at > last);
        REQUIRE(std::isfinite(*at));
        CHECK(agree(box, ray));
        last = *at;
      }
    }
}

TEST_CASE("rays meet balls at the root of the quadratic, and decide tangents exactly",
          "[collide][shapes]") {
  SmallPoints random(2);
  int n_hits = 0, n_tangents = 0;
  for (int i = 0; i < 3000; ++i) {
    const Sphere ball{random.point(8), double(random.below(4))};
    Ray ray{random.point(8), random.point(8)};
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] -= ray.from[k];
    if (ray.direction == Point{}) continue;
    INFO(i);
    REQUIRE(agree(ball, ray));
    const Powers powers(random);
    REQUIRE(agree(Sphere{scaled(ball.centre, powers.place), std::ldexp(ball.radius, powers.place)},
                  scaled(ray, powers)));
    if (!hit(ball, ray)) continue;
    ++n_hits;
    const Exact d = exact(ray.direction), off = cross(d, exact(ball.centre) - exact(ray.from));
    n_tangents += dot(off, off) == Rational(ball.radius * ball.radius) * dot(d, d) ? 1 : 0;
  }
  CHECK(n_hits > 300);
  CHECK(n_tangents > 5);
}

TEST_CASE("a ray that meets a tetrahedron meets it where it enters", "[collide][shapes]") {
  SmallPoints random(3);
  int n_hits = 0;
  for (int n = 0; n < 1500; ++n) {
    const Tetrahedron t{random.points<4>(5)};
    Ray ray{random.point(7), random.point(5)};
    for (std::size_t k = 0; k < 3; ++k) ray.direction[k] -= ray.from[k];
    if (ray.direction == Point{}) continue;
    if (!oracle(t.corners, t.corners, Touching::does_not_count)) continue;  // may lie in its plane
    // The first 16 units of length of the direction reach all tetrahedra.
    Segment reach{ray.from, ray.from};
    for (std::size_t k = 0; k < 3; ++k) reach.to[k] += 16 * ray.direction[k];
    const auto found = hit(t, ray);
    REQUIRE(found.has_value() == intersect(t, reach, Touching::counts));
    if (!found) continue;
    ++n_hits;
    std::optional<Rational> expected;
    for (std::size_t i = 0; i < 4; ++i) {
      const Triangle face{{t.corners[i], t.corners[(i + 1) % 4], t.corners[(i + 2) % 4]}};
      const auto at = exact_hit(face, ray);
      if (at && (!expected || *at < *expected)) expected = at;
    }
    if (intersect(t, ray.from, Touching::counts)) expected = 0;
    REQUIRE(abs(Rational(*found) - *expected) <= *expected * Rational(0x1p-42));
    const Powers powers(random);
    const auto other = hit(scaled(t, powers.place), scaled(ray, powers));
    REQUIRE(other);
    REQUIRE(std::ldexp(*other, powers.speed - powers.place) == Approx(*found).epsilon(0x1p-41));
  }
  CHECK(n_hits > 200);
}

TEST_CASE("no ray from inside leaves a closed surface between its triangles", "[collide][shapes]") {
  // A sphere of triangles with coordinates that are rounded, around 0.1.
  constexpr int n_rows = 8, n_columns = 12;
  const auto vertex = [](int row, int column) {
    const double polar = M_PI * row / n_rows, azimuth = 2 * M_PI * (column % n_columns) / n_columns;
    const double r = row == 0 || row == n_rows ? 0 : std::sin(polar);
    return Point{0.1 + r * std::cos(azimuth), 0.1 + r * std::sin(azimuth), std::cos(polar)};
  };
  std::vector<Triangle> surface;
  for (int r = 0; r < n_rows; ++r)
    for (int c = 0; c < n_columns; ++c) {
      surface.push_back({{vertex(r, c), vertex(r + 1, c), vertex(r + 1, c + 1)}});
      surface.push_back({{vertex(r, c), vertex(r + 1, c + 1), vertex(r, c + 1)}});
    }
  const Point from{0.1, 0.1, 0.05};
  int n_shared = 0;
  for (const Triangle& t : surface)
    for (const double along : {0.0, 0.5, 1.0 / 3, 0.9}) {
      Ray ray{from, {}};
      for (std::size_t k = 0; k < 3; ++k)
        ray.direction[k] = (1 - along) * t.corners[0][k] + along * t.corners[1][k] - from[k];
      int n_hits = 0;
      for (const Triangle& each : surface) n_hits += hit(each, ray) ? 1 : 0;
      REQUIRE(n_hits >= 1);
      n_shared += n_hits > 1 ? 1 : 0;
    }
  CHECK(n_shared > 10);
}
