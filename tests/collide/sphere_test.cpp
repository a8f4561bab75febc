#include "collide/sphere.hpp"

#include "collide/tetrahedron.hpp"
#include "tests/collide/shapes/oracle.hpp"
#include "tests/support/catch.hpp"

#include <boost/multiprecision/cpp_int.hpp>

#include <cmath>
#include <limits>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

/// A squared distance.
struct Fraction {
  Integer over = 0, under = 1;
};

Vector way(const Point& from, const Point& to) {
  Vector d{};
  for (std::size_t k = 0; k < 3; ++k) d[k] = static_cast<Integer>(to[k] - from[k]);
  return d;
}

/// Squared distances from `p` to the corners of a triangle, and to those lines and the plane
/// through them on which the nearest point is within the triangle. The least is the triangle's
/// distance.
std::vector<Fraction> distances2(const Triangle& t, const Point& p) {
  std::vector<Fraction> all;
  const auto& c = t.corners;
  const Vector normal = cross(way(c[0], c[1]), way(c[0], c[2]));
  bool is_inside = normal != Vector{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector edge = way(c[i], c[(i + 1) % 3]), d = way(c[i], p);
    all.push_back({dot(d, d), 1});
    const Vector off = cross(d, edge);
    const Integer along = dot(d, edge), length2 = dot(edge, edge);
    if (along > 0 && along < length2) all.push_back({dot(off, off), length2});
    is_inside = is_inside && dot(cross(edge, d), normal) >= 0;
  }
  const Integer height = dot(normal, way(c[0], p));
  if (is_inside) all.push_back({height * height, dot(normal, normal)});
  return all;
}

bool is_within(const std::vector<Fraction>& distances2, Integer radius, Touching touching) {
  for (const Fraction& d : distances2) {
    const Integer limit = radius * radius * d.under;
    if (touching == Touching::counts ? d.over <= limit : d.over < limit) return true;
  }
  return false;
}

/// The answer for the shapes as they are, and moved and scaled without rounding.
template <class A, class B, class Map>
bool answer(const A& a, const B& b, Touching touching, const Map& map) {
  const bool plain = intersect(a, b, touching);
  for (const auto& [power, offset] : {std::pair{0, 1e12},
                                      {30, 0.0},
                                      {-30, 0.0},
                                      {400, 0.0},
                                      {-400, 0.0},
                                      {1000, 0.0},
                                      {-1070, 0.0}})
    REQUIRE(intersect(map(a, power, offset), map(b, power, offset), touching) == plain);
  return plain;
}

struct MoveAndScale {
  Point operator()(const Point& p, int power, double offset) const {
    return {std::ldexp(p[0], power) + offset, std::ldexp(p[1], power) - offset,
            std::ldexp(p[2], power) + offset};
  }
  Sphere operator()(const Sphere& s, int power, double offset) const {
    return {(*this)(s.centre, power, offset), std::ldexp(s.radius, power)};
  }
  Segment operator()(const Segment& s, int power, double offset) const {
    return {(*this)(s.from, power, offset), (*this)(s.to, power, offset)};
  }
  Aabb operator()(const Aabb& b, int power, double offset) const {
    return {(*this)(b.lo, power, offset), (*this)(b.hi, power, offset)};
  }
  Triangle operator()(Triangle t, int power, double offset) const {
    for (Point& p : t.corners) p = (*this)(p, power, offset);
    return t;
  }
};

}  // namespace

TEST_CASE("balls and triangles, segments, points: as integers say, degenerate ones alike",
          "[collide][shapes]") {
  SmallPoints random(1);
  std::array<std::array<int, 2>, 3> n{};
  const MoveAndScale map;
  for (int i = 0; i < 3000; ++i) {
    const Sphere ball{random.point(8), double(random.below(5))};
    Triangle t{random.points<3>(6)};
    if (i % 8 == 1) t.corners[2] = t.corners[1];
    if (i % 8 == 2) t.corners[2] = t.corners[1] = t.corners[0];
    if (i % 8 == 3)
      for (std::size_t k = 0; k < 3; ++k) t.corners[2][k] = 2 * t.corners[1][k] - t.corners[0][k];
    const auto radius = static_cast<Integer>(ball.radius);
    for (const Touching touching : both) {
      const bool expected = is_within(distances2(t, ball.centre), radius, touching);
      REQUIRE(answer(ball, t, touching, map) == expected);
      REQUIRE(intersect(t, ball, touching) == expected);
      const Segment edge{t.corners[0], t.corners[1]};
      const Triangle flat{{edge.from, edge.to, edge.to}};
      const bool on_edge = is_within(distances2(flat, ball.centre), radius, touching);
      REQUIRE(answer(ball, edge, touching, map) == on_edge);
      const Point& p = t.corners[0];
      const bool at_point = is_within(distances2({{p, p, p}}, ball.centre), radius, touching);
      REQUIRE(answer(ball, p, touching, map) == at_point);
      ++n[0][expected ? 1U : 0U], ++n[1][on_edge ? 1U : 0U], ++n[2][at_point ? 1U : 0U];
    }
  }
  for (const auto& each : n) CHECK(std::min(each[0], each[1]) > 400);
}

TEST_CASE("balls and boxes, balls and balls, as integers say", "[collide][shapes]") {
  SmallPoints random(2);
  const MoveAndScale map;
  for (int i = 0; i < 2000; ++i) {
    const Sphere ball{random.point(9), double(random.below(4))};
    const Sphere other{random.point(9), double(random.below(4))};
    const Aabb box = merged(box_of(random.point(9)), box_of(random.point(9)));
    const Vector between = way(ball.centre, other.centre);
    const auto reach = static_cast<Integer>(ball.radius + other.radius);
    Integer apart2 = 0;
    bool is_inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = std::max({0.0, box.lo[k] - ball.centre[k], ball.centre[k] - box.hi[k]});
      apart2 += static_cast<Integer>(off * off);
      is_inside &= box.lo[k] < ball.centre[k] && ball.centre[k] < box.hi[k];
    }
    for (const Touching touching : both) {
      REQUIRE(answer(ball, other, touching, map) ==
              is_within({{dot(between, between), 1}}, reach, touching));
      const bool expected = is_within({{apart2, 1}}, static_cast<Integer>(ball.radius), touching) ||
                            (is_inside && touching == Touching::does_not_count);
      REQUIRE(answer(ball, box, touching, map) == expected);
    }
  }
}

TEST_CASE("a ball that touches a face is decided to the last bit", "[collide][shapes]") {
  // The plane x + 2 y + 2 z = 0 is at distance 3 of (1, 2, 2).
  const Triangle face{{Point{-20, 0, 10}, Point{20, -20, 10}, Point{-2, 21, -20}}};
  const Point centre{1, 2, 2};
  for (const int power : {0, -30, 30, -900}) {
    const MoveAndScale map;
    const Triangle t = map(face, power, 0);
    const Point c = map(centre, power, 0);
    const double r = std::ldexp(3.0, power);
    CHECK(intersect(Sphere{c, r}, t, Touching::counts));
    CHECK_FALSE(intersect(Sphere{c, r}, t, Touching::does_not_count));
    CHECK_FALSE(intersect(Sphere{c, std::nextafter(r, 0.0)}, t, Touching::counts));
    CHECK(intersect(Sphere{c, std::nextafter(r, HUGE_VAL)}, t, Touching::does_not_count));
  }
}

TEST_CASE("a ball and a tetrahedron: the centre inside, or a face within the radius",
          "[collide][shapes]") {
  SmallPoints random(3);
  for (int i = 0; i < 3000; ++i) {
    const Sphere ball{random.point(7), double(random.below(3))};
    const Tetrahedron t{random.points<4>(6)};
    for (const Touching touching : both) {
      bool expected = oracle(t.corners, {&ball.centre, 1}, touching);
      for (std::size_t f = 0; f < 4; ++f) {
        const Triangle face{{t.corners[f], t.corners[(f + 1) % 4], t.corners[(f + 2) % 4]}};
        expected |=
            is_within(distances2(face, ball.centre), static_cast<Integer>(ball.radius), touching);
      }
      REQUIRE(intersect(t, ball, touching) == expected);
      REQUIRE(intersect(ball, t, touching) == expected);
    }
  }
}

TEST_CASE("the box of a ball contains it, and no smaller box of doubles does",
          "[collide][shapes]") {
  using boost::multiprecision::cpp_rational;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    Sphere s{{some(random), 1e12 * some(random), std::ldexp(some(random), -1040)}, 0};
    s.radius = std::ldexp(std::abs(some(random)), i % 80 - 60);
    const Aabb box = box_of(s);
    REQUIRE(is_valid(box));
    for (std::size_t k = 0; k < 3; ++k) {
      const cpp_rational low = cpp_rational(s.centre[k]) - cpp_rational(s.radius);
      const cpp_rational high = cpp_rational(s.centre[k]) + cpp_rational(s.radius);
      REQUIRE(cpp_rational(box.lo[k]) <= low);
      REQUIRE(cpp_rational(std::nextafter(box.lo[k], HUGE_VAL)) > low);
      REQUIRE(cpp_rational(box.hi[k]) >= high);
      REQUIRE(cpp_rational(std::nextafter(box.hi[k], -HUGE_VAL)) < high);
    }
  }
}

TEST_CASE("the box of a ball that is none is not valid", "[collide][shapes]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Sphere& s :
       {Sphere{{0, 0, 0}, -1}, Sphere{{1, 1, 1}, -1e-300}, Sphere{{0, 0, 0}, nan},
        Sphere{{0, nan, 0}, 1}, Sphere{{0, HUGE_VAL, 0}, 1}, Sphere{{0, -HUGE_VAL, 0}, 1},
        Sphere{{1.7e308, 0, 0}, 1.7e308}, Sphere{{0, 0, 0}, HUGE_VAL}})
    CHECK_FALSE(is_valid(box_of(s)));
  CHECK(is_valid(box_of(Sphere{{0, 0, 0}, 0})));
}
