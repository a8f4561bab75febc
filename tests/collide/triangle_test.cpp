#include "collide/triangle.hpp"

#include "tests/collide/shapes/oracle.hpp"
#include "tests/collide/shapes/rational.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tess::collide;
using namespace tess::collide::testing;

namespace {

template <class Map>
Triangle mapped(const Triangle& t, const Map& map) {
  Triangle out = t;
  for (Point& p : out.corners)
    for (std::size_t k = 0; k < 3; ++k) p[k] = map(p[k], k);
  return out;
}

Triangle rotated(const Triangle& t, std::size_t by) {
  const auto& c = t.corners;
  return {{c[by % 3], c[(by + 1) % 3], c[(by + 2) % 3]}};
}

/// Random triangles, of which some are segments, some points, and some lie in one plane.
std::array<Triangle, 2> some_pair(SmallPoints& random, int size, std::size_t kind) {
  std::array<Triangle, 2> t{Triangle{random.points<3>(size)}, Triangle{random.points<3>(size)}};
  const std::size_t one = random.below(2);
  switch (kind % 8) {
    case 1:
      t[one].corners[2] = t[one].corners[0];
      break;
    case 2:
      t[one].corners.fill(t[one].corners[0]);
      break;
    case 3:
      for (Triangle& each : t)
        for (Point& p : each.corners) p[kind / 8 % 3] = 1;
      break;
    case 4:
      t[1].corners[random.below(3)] = t[0].corners[random.below(3)];
      break;
    case 5:
      t[1].corners[0] = t[0].corners[random.below(3)];
      t[1].corners[1] = t[0].corners[random.below(3)];
      break;
    case 6:  // in the plane x + y + z = 3
      for (Triangle& each : t)
        for (Point& p : each.corners) p[2] = 3 - p[0] - p[1];
      break;
    case 7: {  // three corners on one line
      auto& [a, b, c] = t[one].corners;
      for (std::size_t k = 0; k < 3; ++k) c[k] = 2 * b[k] - a[k];
      break;
    }
    default:
      break;
  }
  return t;
}

}  // namespace

TEST_CASE("triangles intersect as the oracle says, degenerate and coplanar ones alike",
          "[collide][shapes]") {
  SmallPoints random(1);
  std::array<std::array<std::size_t, 2>, 2> n{};
  for (std::size_t i = 0; i < 60'000; ++i) {
    const auto [a, b] = some_pair(random, 2 + int(i % 5), i / 5);
    for (const Touching touching : both) {
      const bool expected = oracle(a.corners, b.corners, touching);
      INFO(i);
      REQUIRE(intersect(a, b, touching) == expected);
      ++n[touching == Touching::counts ? 1U : 0U][expected ? 1U : 0U];
    }
  }
  CHECK(n[1][1] > 15'000);
  CHECK(n[1][0] > 15'000);
  CHECK(n[0][1] > 1'500);
}

TEST_CASE("exchange, order of corners, exact translation and scaling do not change an answer",
          "[collide][shapes]") {
  SmallPoints random(2);
  for (std::size_t i = 0; i < 25'000; ++i) {
    const auto [a, b] = some_pair(random, 2 + int(i % 5), i / 5);
    const Touching touching = both[i % 2];
    const bool expected = intersect(a, b, touching);
    const std::size_t turn = random.below(3);
    REQUIRE(intersect(b, a, touching) == expected);
    REQUIRE(intersect(rotated(a, turn), rotated(b, turn + i), touching) == expected);
    const Triangle reversed{{a.corners[1], a.corners[0], a.corners[2]}};
    REQUIRE(intersect(reversed, b, touching) == expected);
    const std::array offset{1e12, -3e11, 12345.0};
    const auto move = [&](double x, std::size_t k) { return x + offset[k]; };
    REQUIRE(intersect(mapped(a, move), mapped(b, move), touching) == expected);
    const int power = i % 4 == 0 ? 30 : i % 4 == 1 ? -30 : i % 4 == 2 ? -1060 : 1010;
    const auto scale = [&](double x, std::size_t) { return std::ldexp(x, power); };
    REQUIRE(intersect(mapped(a, scale), mapped(b, scale), touching) == expected);
    // Each axis by a power of its own: needles and flat triangles.
    const auto stretch = [](double x, std::size_t k) { return std::ldexp(x, int(k) * 60 - 60); };
    REQUIRE(intersect(mapped(a, stretch), mapped(b, stretch), touching) == expected);
  }
}

TEST_CASE("triangles of float are decided as those of double", "[collide][shapes]") {
  SmallPoints random(3);
  for (std::size_t i = 0; i < 20'000; ++i) {
    const auto [a, b] = some_pair(random, 4, i);
    TriangleOf<float> fa{}, fb{};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) {
        fa.corners[c][k] = static_cast<float>(a.corners[c][k]) * 0.1F;
        fb.corners[c][k] = static_cast<float>(b.corners[c][k]) * 0.1F;
      }
    REQUIRE(intersect(fa, fb, both[i % 2]) == intersect(in_double(fa), in_double(fb), both[i % 2]));
  }
}

TEST_CASE("triangles that only touch, one ulp from a gap and one from a cut", "[collide][shapes]") {
  // A corner on the face z = 0 of a large triangle, at coordinates that no power of two divides.
  const Triangle floor{{Point{-0.1, -0.1, 0}, Point{7.3, -0.3, 0}, Point{-0.7, 9.1, 0}}};
  const double x = 0.1 + 0.2, y = 0.7 / 3;
  const auto above = [&](double z) {
    return Triangle{{Point{x, y, z}, Point{x + 0.1, y, 1}, Point{x, y + 0.1, 1}}};
  };
  const double least = 0x1p-1074;
  CHECK(intersect(floor, above(0), Touching::counts));
  CHECK_FALSE(intersect(floor, above(0), Touching::does_not_count));
  CHECK_FALSE(intersect(floor, above(least), Touching::counts));
  CHECK(intersect(floor, above(-least), Touching::counts));
  CHECK(intersect(floor, above(-least), Touching::does_not_count));
}

TEST_CASE("an intersection that survives small translations implies boxes that do",
          "[collide][shapes]") {
  SmallPoints random(4);
  for (std::size_t i = 0; i < 50'000; ++i) {
    const auto [a, b] = some_pair(random, 4, i);
    for (const Touching touching : both)
      if (intersect(a, b, touching)) REQUIRE(overlap(box_of(a), box_of(b), touching));
  }
}

namespace {

/// Six times the signed volume of a triangle's corners and a point.
Rational volume(const Triangle& t, const Point& p) {
  const Exact a = exact(t.corners[0]);
  return dot(cross(exact(t.corners[1]) - a, exact(t.corners[2]) - a), exact(p) - a);
}

/// Where edges of `a` meet the face of `b`, exactly.
std::vector<Exact> edge_hits(const Triangle& a, const Triangle& b) {
  std::vector<Exact> hits;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = a.corners[i], &q = a.corners[(i + 1) % 3];
    const Rational vp = volume(b, p), vq = volume(b, q);
    if (vp == vq || vp.sign() * vq.sign() > 0) continue;
    const Rational t = vp / (vp - vq);
    const Exact x = exact(p) + t * (exact(q) - exact(p));
    // Inside the triangle, in each projection: no two edges have x strictly on opposite sides.
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
      bool left = false, right = false;
      for (std::size_t e = 0; e < 3; ++e) {
        const Point &c = b.corners[e], &d = b.corners[(e + 1) % 3];
        const Rational side = (Rational(d[u]) - Rational(c[u])) * (x[v] - Rational(c[v])) -
                              (Rational(d[v]) - Rational(c[v])) * (x[u] - Rational(c[u]));
        left |= side.sign() > 0;
        right |= side.sign() < 0;
      }
      inside &= !(left && right);
    }
    if (inside) hits.push_back(x);
  }
  return hits;
}

/// The exact point is one of `hits` to 2^-42 of `largest`.
bool is_near_one(const Point& p, const std::vector<Exact>& hits, double largest) {
  for (const Exact& h : hits) {
    bool near = true;
    for (std::size_t k = 0; k < 3; ++k)
      near &= abs(Rational(p[k]) - h[k]) <= Rational(std::ldexp(largest, -42));
    if (near) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("a contact segment ends where edges meet faces, within 2^-42", "[collide][shapes]") {
  SmallPoints random(5);
  std::size_t n_segments = 0, n_points = 0;
  for (std::size_t i = 0; i < 1500; ++i) {
    auto [a, b] = some_pair(random, 4, i % 2 == 0 ? 0 : 4);
    double largest = 4;
    if (i % 3 == 0) {  // almost in one plane, with coordinates that are not whole
      const auto flatten = [&](double x, std::size_t k) { return k == 2 ? x * 1e-13 : x * 0.1; };
      a = mapped(a, flatten), b = mapped(b, flatten), largest = 0.4;
    } else if (i % 3 == 1) {
      const auto move = [](double x, std::size_t) { return x * 0.001 + 1e6; };
      a = mapped(a, move), b = mapped(b, move), largest = 1e6;
    }
    const auto segment = contact_segment(a, b);
    if (!segment) continue;
    INFO(i);
    REQUIRE(intersect(a, b, Touching::counts));
    std::vector<Exact> hits = edge_hits(a, b);
    for (const Exact& h : edge_hits(b, a)) hits.push_back(h);
    REQUIRE(is_near_one(segment->from, hits, largest));
    REQUIRE(is_near_one(segment->to, hits, largest));
    // It is the longest: as long as the largest distance of two such points.
    double longest2 = 0;
    for (const Exact& p : hits)
      for (const Exact& q : hits)
        longest2 = std::max(longest2, static_cast<double>(distance2(p, q)));
    double length2 = 0;
    for (std::size_t k = 0; k < 3; ++k)
      length2 += (segment->to[k] - segment->from[k]) * (segment->to[k] - segment->from[k]);
    CHECK(std::sqrt(length2) == Approx(std::sqrt(longest2)).margin(std::ldexp(largest, -40)));
    ++(longest2 > 0 ? n_segments : n_points);
  }
  CHECK(n_segments > 75);
  CHECK(n_points > 50);
}

TEST_CASE("no contact segment: apart, in one plane, or degenerate", "[collide][shapes]") {
  const Triangle flat{{Point{0, 0, 0}, Point{2, 0, 0}, Point{0, 2, 0}}};
  CHECK_FALSE(contact_segment(flat, {{Point{0, 0, 1}, Point{2, 0, 1}, Point{0, 2, 2}}}));
  CHECK_FALSE(contact_segment(flat, flat));
  CHECK_FALSE(contact_segment(flat, {{Point{0, 0, -1}, Point{0, 0, 1}, Point{0, 0, 1}}}));
  const auto upright =
      contact_segment(flat, {{Point{0.5, -1, -1}, Point{0.5, 3, -1}, Point{0.5, 1, 1}}});
  REQUIRE(upright);
  const Point low{0.5, 0, 0}, high{0.5, 1.5, 0};
  CHECK((*upright == Segment{low, high} || *upright == Segment{high, low}));
}
