#include "collide/penetration.hpp"

#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numeric>
#include <random>

using namespace tess::collide;

namespace {

/// The surface of the box from `lo` to `hi`, normals outward.
std::vector<Triangle> box_surface(const Point& lo, const Point& hi) {
  std::vector<Triangle> out;
  const auto corner = [&](std::size_t k, bool high, bool first, bool second) {
    Point p{};
    p[k] = high ? hi[k] : lo[k];
    p[(k + 1) % 3] = first ? hi[(k + 1) % 3] : lo[(k + 1) % 3];
    p[(k + 2) % 3] = second ? hi[(k + 2) % 3] : lo[(k + 2) % 3];
    return p;
  };
  for (std::size_t k = 0; k < 3; ++k)
    for (const bool high : {false, true}) {
      const Point a = corner(k, high, false, false), b = corner(k, high, high, !high),
                  c = corner(k, high, true, true), d = corner(k, high, !high, high);
      out.push_back({{a, b, c}});
      out.push_back({{a, c, d}});
    }
  return out;
}

/// A bumpy ball around the origin, normals outward.
std::vector<Triangle> bumpy_ball(std::uint64_t seed) {
  constexpr int n_rows = 10, n_columns = 16;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> radius(0.5, 1.5);
  std::array<std::array<Point, n_columns>, n_rows + 1> v{};
  for (int row = 0; row <= n_rows; ++row)
    for (int column = 0; column < n_columns; ++column) {
      const bool is_pole = row == 0 || row == n_rows;
      const double polar = M_PI * row / n_rows, azimuth = 2 * M_PI * column / n_columns;
      const double r = is_pole ? 1 : radius(random), s = is_pole ? 0 : std::sin(polar);
      v[std::size_t(row)][std::size_t(column)] = {r * s * std::cos(azimuth),
                                                  r * s * std::sin(azimuth), r * std::cos(polar)};
    }
  std::vector<Triangle> out;
  for (std::size_t row = 0; row < n_rows; ++row)
    for (std::size_t c = 0; c < n_columns; ++c) {
      const std::size_t d = (c + 1) % n_columns;
      out.push_back({{v[row][c], v[row + 1][c], v[row + 1][d]}});
      out.push_back({{v[row][c], v[row + 1][d], v[row][d]}});
    }
  return out;
}

/// The winding number as a sum of solid angles (van Oosterom and Strackee 1983).
double winding_by_angles(const std::vector<Triangle>& triangles, const Point& p) {
  double sum = 0;
  for (const Triangle& t : triangles) {
    std::array<Point, 3> r{};
    std::array<double, 3> l{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) r[i][k] = t.corners[i][k] - p[k];
      l[i] = std::hypot(r[i][0], r[i][1], r[i][2]);
    }
    const auto dot = [&](std::size_t i, std::size_t j) {
      return r[i][0] * r[j][0] + r[i][1] * r[j][1] + r[i][2] * r[j][2];
    };
    const double volume = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) +
                          r[0][1] * (r[1][2] * r[2][0] - r[1][0] * r[2][2]) +
                          r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    sum += 2 * std::atan2(volume, l[0] * l[1] * l[2] + dot(0, 1) * l[2] + dot(1, 2) * l[0] +
                                      dot(2, 0) * l[1]);
  }
  return sum / (4 * M_PI);
}

ClosedModel model_of(const std::vector<Triangle>& triangles) {
  return ClosedModel{std::span<const Triangle>(triangles)};
}

}  // namespace

TEST_CASE("in a box the way out is the shortest to a face", "[collide][queries]") {
  for (const auto& [scale, offset] : {std::pair{1.0, 0.0},
                                      {1.0, 1e12},
                                      {0x1p-30, 0.0},
                                      {0x1p30, 0.0},
                                      {0x1p-300, 0.0},
                                      {0x1p-540, 0.0},
                                      {0x1p-1000, 0.0},
                                      {0x1p510, 0.0},
                                      {0x1p1000, 0.0}}) {
    const auto place = [&, s = scale, o = offset](double x, double y, double z) {
      return Point{o + s * x, o + s * y, o + s * z};
    };
    const auto surface = box_surface(place(0, 0, 0), place(8, 16, 32));
    const ClosedModel model = model_of(surface);
    // All points of a lattice: on rays through edges, corners and diagonals of faces.
    for (int x = -1; x <= 9; ++x)
      for (int y = -1; y <= 17; ++y)
        for (int z = -1; z <= 33; z += 2) {
          const int depth = std::min({x, 8 - x, y, 16 - y, z, 32 - z});
          const auto found = model.penetration(place(x, y, z));
          REQUIRE(found.has_value() == (depth > 0));
          if (!found) continue;
          REQUIRE(found->depth == depth * scale);
          const Point& d = found->direction;
          REQUIRE(std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]) == 1);
          const Point q = place(x + depth * d[0], y + depth * d[1], z + depth * d[2]);
          REQUIRE(found->nearest == q);
          REQUIRE(offset_to(surface[found->triangle], q) == Point{});
        }
  }
}

TEST_CASE("the winding number of a bumpy ball is the sum of solid angles", "[collide][queries]") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> some(-1.4, 1.4);
  int n_inside = 0, n_faces = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const auto triangles = bumpy_ball(seed);
    auto turned = triangles;
    for (Triangle& t : turned) std::swap(t.corners[1], t.corners[2]);
    const ClosedModel outward = model_of(triangles), inward = model_of(turned);
    for (int i = 0; i < 150; ++i) {
      Point p{some(random), some(random), some(random)};
      if (i % 3 == 0) p[1] = triangles[std::size_t(i)].corners[0][1];  // level with a corner
      if (i % 3 == 1)
        for (std::size_t k = 1; k < 3; ++k) p[k] = triangles[std::size_t(i)].corners[1][k];
      const double expected = winding_by_angles(triangles, p);
      if (std::abs(expected - std::round(expected)) > 1e-6) continue;  // on the surface
      REQUIRE(outward.winding_number(p) == std::lround(expected));
      REQUIRE(inward.winding_number(p) == -std::lround(expected));
      const auto found = outward.penetration(p);
      REQUIRE(found.has_value() == (std::lround(expected) != 0));
      REQUIRE(inward.penetration(p).has_value() == found.has_value());
      if (!found) continue;
      ++n_inside;
      double least = HUGE_VAL;
      for (const Triangle& t : triangles) least = std::min(least, distance2(t, p));
      REQUIRE(found->depth == Approx(std::sqrt(least)).epsilon(1e-12));
      // Just before the surface the point is inside, and just behind a face outside.
      const auto at = [&](double part) {
        Point q = p;
        for (std::size_t k = 0; k < 3; ++k) q[k] += part * found->depth * found->direction[k];
        return q;
      };
      REQUIRE(outward.winding_number(at(1 - 1e-9)) == 1);
      const auto& c = triangles[found->triangle].corners;
      double along = 0;  // the larger of the cosines to two edges
      for (const std::size_t e : {1U, 2U}) {
        const Point way{c[e][0] - c[0][0], c[e][1] - c[0][1], c[e][2] - c[0][2]};
        const Point& d = found->direction;
        along = std::max(along, std::abs(way[0] * d[0] + way[1] * d[1] + way[2] * d[2]));
      }
      if (along > 1e-9) continue;  // the nearest point is on an edge
      REQUIRE(outward.winding_number(at(1 + 1e-6 / found->depth)) == 0);
      ++n_faces;
    }
  }
  CHECK(n_inside > 100);
  CHECK(n_faces > 30);
}

TEST_CASE("a surface that covers a point twice winds twice", "[collide][queries]") {
  auto both = box_surface({0, 0, 0}, {2, 2, 2});
  for (const Triangle& t : box_surface({1, 1, 1}, {3, 3, 3})) both.push_back(t);
  const ClosedModel model = model_of(both);
  CHECK(model.winding_number({0.5, 0.5, 0.5}) == 1);
  CHECK(model.winding_number({1.5, 1.5, 1.5}) == 2);
  CHECK(model.winding_number({2.5, 2.5, 2.5}) == 1);
  CHECK(model.winding_number({2.5, 0.5, 0.5}) == 0);
}

TEST_CASE("a point one part in 1e15 below a face has a depth and a direction",
          "[collide][queries]") {
  const ClosedModel model = model_of(box_surface({0, 0, 0}, {1, 1, 1}));
  const double just_below = std::nextafter(1.0, 0.0);
  const auto found = model.penetration({0.3, 0.4, just_below});
  REQUIRE(found);
  CHECK(found->depth == 1 - just_below);
  CHECK(found->direction == Point{0, 0, 1});
  CHECK_FALSE(model.penetration({0.3, 0.4, 1}));
}

TEST_CASE("near an edge the nearer face counts, though the squares of both depths are zero",
          "[collide][queries]") {
  const ClosedModel model = model_of(box_surface({0, 0, 0}, {1, 1, 1}));
  const auto found = model.penetration({1e-170, 1e-180, 0.3});
  REQUIRE(found);
  CHECK(found->depth == 1e-180);
  CHECK(found->direction == Point{0, -1, 0});
}

TEST_CASE("only corners of the triangles that were named are tested, each once",
          "[collide][queries]") {
  const auto a = box_surface({-1, -1, -1}, {0.25, 0.25, 0.25});
  const ClosedModel b = model_of(box_surface({0, 0, 0}, {1, 1, 1}));
  std::vector<std::uint32_t> all(a.size());
  std::iota(all.begin(), all.end(), 0U);
  const auto found = penetrating_points(a, all, b);
  REQUIRE(found.size() == 1);
  CHECK(found[0].point == Point{0.25, 0.25, 0.25});
  CHECK(found[0].penetration.depth == 0.25);
  const std::vector<std::uint32_t> lower{0, 1};  // the face x = -1
  CHECK(penetrating_points(a, lower, b).empty());
  const std::vector<std::uint32_t> beyond{0, 12};
  CHECK_THROWS_WITH(penetrating_points(a, beyond, b), Contains("at position 12 of 12"));
}

TEST_CASE("an open surface is refused, and the edge is named", "[collide][queries]") {
  auto triangles = box_surface({0, 0, 0}, {1, 1, 1});
  triangles.pop_back();
  CHECK_THROWS_WITH(model_of(triangles), Contains("edge of triangle"));
  triangles = box_surface({0, 0, 0}, {1, 1, 1});
  std::swap(triangles[4].corners[0], triangles[4].corners[1]);
  CHECK_THROWS_AS(model_of(triangles), tess::Error);
  triangles = box_surface({0, 0, 0}, {1, 1, 1});
  triangles[7].corners[1][2] = std::nan("");
  CHECK_THROWS_WITH(model_of(triangles), Contains("object 7"));
  CHECK_FALSE(model_of({}).penetration({0, 0, 0}));
  CHECK_THROWS_AS(model_of({}).penetration({std::nan(""), 0, 0}), tess::Error);
}
