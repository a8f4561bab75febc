#include "m2m/overset/wall.hpp"

#include "apps/overset/body.hpp"
#include "m2m/overset/rim.hpp"
#include "runtime/core/serialize.hpp"
#include "tests/m2m/overset/voxel_body.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tess;
using namespace tess::m2m;
using overset::Body, tess::test::VoxelBody;

namespace {

using Triangles = std::vector<std::array<VertexId, 3>>;

/// The sum of the solid angles over 4π (van Oosterom and Strackee 1983).
double winding_by_angles(const std::vector<Point>& points, const Triangles& triangles,
                         const Point& p) {
  double sum = 0;
  for (const auto& t : triangles) {
    const auto at = [&](std::size_t i) {
      return difference(points[static_cast<std::size_t>(t[i])], p);
    };
    const Point a = at(0), b = at(1), c = at(2);
    const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), lc = std::sqrt(dot(c, c));
    sum += 2 * std::atan2(dot(a, cross(b, c)),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

/// A box with sides of two triangles each, its normals outwards.
Triangles add_box(std::vector<Point>& points, const Point& lo, const Point& hi) {
  const auto first = static_cast<VertexId>(points.size());
  for (int i = 0; i < 8; ++i)
    points.push_back(
        {(i & 1) != 0 ? hi[0] : lo[0], (i & 2) != 0 ? hi[1] : lo[1], (i & 4) != 0 ? hi[2] : lo[2]});
  Triangles sides{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (auto& t : sides)
    for (VertexId& v : t) v += first;
  return sides;
}

/// All answers of a body of cubes at multiples of half a cube, mapped by x -> offset + scale x.
void check_voxels(const VoxelBody& body, std::mt19937& random, double scale, double offset) {
  const auto place = [&](double x, double y, double z) {
    return Point{offset + scale * x, offset + scale * y, offset + scale * z};
  };
  const test::VoxelSurface surface(body, random, place);
  if (surface.triangles.empty()) return;
  const Wall wall(surface.points, surface.triangles);
  CHECK(wall.rim().n_edges == 0);
  std::size_t n_wrong = 0;
  constexpr int end = 2 * VoxelBody::n + 1;
  for (int x = -1; x <= end; ++x)
    for (int y = -1; y <= end; ++y)
      for (int z = -1; z <= end; ++z)
        if (wall.locate(place(0.5 * x, 0.5 * y, 0.5 * z)) != body.answer({x, y, z})) ++n_wrong;
  CHECK(n_wrong == 0);
}

}  // namespace

TEST_CASE("points in, on and outside bodies of cubes are told apart exactly", "[m2m][overset]") {
  std::mt19937 random(1);
  for (int k = 0; k < 60; ++k) {
    const VoxelBody body(random, k % 3 == 0 ? 0.2 : k % 3 == 1 ? 0.5 : 0.8);
    INFO("body " << k);
    check_voxels(body, random, 1, 0);
    check_voxels(body, random, 1e90, 0);
    check_voxels(body, random, 1e-90, 0);
    check_voxels(body, random, 1, 1e8);
    check_voxels(body, random, 0x1p-20, -1e8);
  }
}

TEST_CASE("the winding number is the sum of solid angles", "[m2m][overset]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<> in_cube(0.1, 0.9);
  int n_inside = 0;
  for (const char* name : {"ball:5", "box:4", "star:8", "torus:6"}) {
    Body body = overset::parse_body(name);
    body.radius = 0.35;
    const TetMesh mesh = overset::mesh_around(body);
    const Triangles surface = overset::surface_of(body);
    const Wall wall(mesh.points, surface);
    for (int k = 0; k < 500; ++k) {
      const Point p{in_cube(random), in_cube(random), in_cube(random)};
      const double w = winding_by_angles(mesh.points, surface, p);
      INFO(name << " at " << p[0] << ' ' << p[1] << ' ' << p[2]);
      CHECK(std::abs(w - wall.winding_number(p)) < 1e-9);
      n_inside += wall.winding_number(p);
    }
    for (const auto& t : surface)
      for (const VertexId v : t)
        CHECK(wall.locate(mesh.points[static_cast<std::size_t>(v)]) == Containment::on_wall);
  }
  CHECK(n_inside > 200);
}

TEST_CASE("points an ulp from a thin wall are told apart", "[m2m][overset]") {
  std::vector<Point> points;
  const double lo = 0.3, hi = std::nextafter(std::nextafter(lo, 1), 1);
  const Triangles plate = add_box(points, {lo, 0, 0}, {hi, 1, 1});
  const Wall wall(points, plate);
  for (const double y : {0.25, 0.5, 0.6}) {
    CHECK(wall.locate({std::nextafter(lo, 0), y, 0.5}) == Containment::outside);
    CHECK(wall.locate({lo, y, 0.5}) == Containment::on_wall);
    CHECK(wall.locate({std::nextafter(lo, 1), y, 0.5}) == Containment::inside);
    CHECK(wall.locate({hi, y, 0.5}) == Containment::on_wall);
    CHECK(wall.locate({std::nextafter(hi, 1), y, 0.5}) == Containment::outside);
  }
}

TEST_CASE("a shell that faces the other way is a cavity, one that faces the same way is not",
          "[m2m][overset]") {
  std::vector<Point> points;
  Triangles both = add_box(points, {0, 0, 0}, {1, 1, 1});
  Triangles inner = add_box(points, {0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}), turned = both;
  both.insert(both.end(), inner.begin(), inner.end());
  for (const auto& [a, b, c] : inner) turned.push_back({a, c, b});
  const Wall solid(points, both), hollow(points, turned);
  const Point middle{0.5, 0.5, 0.5}, shell{0.125, 0.5, 0.5};
  CHECK(solid.winding_number(middle) == 2);
  CHECK(solid.locate(middle) == Containment::inside);
  CHECK(hollow.locate(middle) == Containment::outside);
  CHECK(solid.locate(shell) == Containment::inside);
  CHECK(hollow.locate(shell) == Containment::inside);
}

TEST_CASE("a wall with its triangles inwards holds the same points", "[m2m][overset]") {
  std::vector<Point> points;
  Triangles box = add_box(points, {0, 0, 0}, {1, 1, 1});
  for (auto& t : box) std::swap(t[0], t[1]);
  CHECK(Wall(points, box).locate({0.5, 0.5, 0.5}) == Containment::inside);
  CHECK(Wall(points, box).locate({0.5, 0.5, 1.5}) == Containment::outside);
}

TEST_CASE("holes and flipped triangles of a wall are capped", "[m2m][overset]") {
  std::mt19937 random(3);
  VoxelBody body(random, 1);
  const auto place = [](int x, int y, int z) { return Point{double(x), double(y), double(z)}; };
  const test::VoxelSurface whole(body, random, place);
  for (const bool flipped : {false, true}) {
    test::VoxelSurface surface = whole;
    for (const std::size_t t : {std::size_t{77}, std::size_t{30}, std::size_t{5}})
      if (flipped)
        std::swap(surface.triangles[t][0], surface.triangles[t][1]);
      else
        surface.triangles.erase(surface.triangles.begin() + static_cast<std::ptrdiff_t>(t));
    const Wall wall(surface.points, surface.triangles);
    CHECK(wall.rim().n_edges == (flipped ? 18 : 9));
    CHECK(wall.rim().n_loops == (flipped ? 6 : 3));
    CHECK(wall.rim().cap_share > 0.01);
    std::size_t n_wrong = 0;
    for (int x = -1; x <= 9; ++x)
      for (int y = -1; y <= 9; ++y)
        for (int z = -1; z <= 9; ++z)
          if (wall.locate({0.5 * x, 0.5 * y, 0.5 * z}) != body.answer({x, y, z})) ++n_wrong;
    CHECK(n_wrong == 0);
  }
}

TEST_CASE("holes that meet at two vertices get a cap each", "[m2m][overset]") {
  std::vector<Point> points;
  for (int i = 0; i < 7; ++i) points.push_back({std::cos(i), std::sin(i), 0.1 * i});
  // Without others around them: the triangle 1 3 2, and the pentagon 0 5 2 4 1 about vertex 6.
  Triangles triangles{{1, 3, 2}, {1, 0, 6}, {0, 5, 6}, {5, 2, 6}, {2, 4, 6}, {4, 1, 6}};
  const Rim rim = m2m::close(points, triangles);
  CHECK(rim.n_edges == 8);
  CHECK(rim.n_loops == 2);
  CHECK(points.size() == 7 + 2);
  CHECK(triangles.size() == 6 + 3 + 5);
  CHECK(m2m::close(points, triangles).n_edges == 0);
}

TEST_CASE("a wall without a side is closed, one with half of its sides is refused",
          "[m2m][overset]") {
  std::vector<Point> points;
  Triangles box = add_box(points, {0, 0, 0}, {1, 1, 1});
  box.resize(10);
  const Wall wall(points, box);
  CHECK(wall.rim().cap_share == Approx(1.0 / 6));
  CHECK(wall.locate({0.9, 0.5, 0.5}) == Containment::inside);
  CHECK(wall.locate({1.1, 0.5, 0.5}) == Containment::outside);
  box.resize(6);
  CHECK_THROWS_WITH(Wall(points, box), Contains("the wall is open"));
}

TEST_CASE("a closed wall whose triangles are turned is refused for that, with an edge",
          "[m2m][overset]") {
  std::vector<Point> points;
  Triangles box = add_box(points, {0, 0, 0}, {1, 1, 1});
  for (std::size_t t = 0; t < box.size(); t += 2) std::swap(box[t][1], box[t][2]);
  box.insert(box.begin(), {0, 0, 1});  // without an area
  CHECK_THROWS_WITH(Wall(points, box), Contains("not oriented alike: triangles 2 and 5 (from 0)") &&
                                           Contains("in the same direction") && !Contains("open"));
}

TEST_CASE("a wall that cannot be used is refused", "[m2m][overset]") {
  std::vector<Point> points;
  Triangles box = add_box(points, {0, 0, 0}, {1, 1, 1});
  CHECK_THROWS_WITH(Wall(points, {}), Contains("no triangle"));
  CHECK_THROWS_WITH(Wall(points, Triangles{{0, 0, 1}}), Contains("no triangle"));
  CHECK_THROWS_WITH(Wall(points, Triangles{{0, 1, 8}}), Contains("names point 8 of 8"));
  points[3][1] = std::nan("");
  CHECK_THROWS_WITH(Wall(points, box), Contains("point 3 of the wall"));
}

TEST_CASE("the part of a wall that a box sees gives the same answers there", "[m2m][overset]") {
  std::mt19937 random(4);
  std::uniform_real_distribution<> in_cube(0, 1);
  Body body = overset::parse_body("torus:8");
  const TetMesh mesh = overset::mesh_around(body);
  const Wall whole(mesh.points, overset::surface_of(body));
  int n_pruned = 0;
  for (int k = 0; k < 50; ++k) {
    const Point a{in_cube(random), in_cube(random), in_cube(random)};
    const Aabb box = collide::box_around(
        std::array<Point, 2>{a, Point{in_cube(random), in_cube(random), in_cube(random)}});
    const Wall part = from_bytes<Wall>(to_bytes(whole.seen_from(box)));
    n_pruned += part.n_triangles() < whole.n_triangles() ? 1 : 0;
    for (int i = 0; i < 50; ++i) {
      Point p{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = box.lo[axis] + in_cube(random) * (box.hi[axis] - box.lo[axis]);
      CHECK(part.locate(p) == whole.locate(p));
    }
  }
  CHECK(n_pruned > 25);
}
