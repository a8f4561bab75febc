#include "collide/dn_field/build_field.hpp"

#include "apps/kit/worst.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/collide/dn_field/field_samples.hpp"
#include "tests/collide/dn_field/triangle_distance.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <random>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

double box_distance(Vec3 p, Vec3 half) {
  const Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
  const Vec3 outside{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
  return norm(outside) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

TEST_CASE("distances to a box are those of the formula at every voxel", "[dn_field]") {
  const Vec3 half{0.5, 0.3, 0.7};
  const Field field = build_field(make_box(half), grid_around({-half, half}, 33, 0.4));
  double worst = 0;
  for_each_voxel(field.grid, [&](std::size_t at, Vec3 p) {
    kit::worsen(worst, std::abs(static_cast<double>(field.distance[at]) - box_distance(p, half)));
  });
  CHECK(worst < 1e-6);
}

TEST_CASE("the tree's closest point and winding number are those of brute force", "[dn_field]") {
  const Surface torus = make_torus(1, 0.4, 24);
  const Bvh tree(torus);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-1.6, 1.6);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 p{anywhere(random), anywhere(random), anywhere(random)};
    double nearest = HUGE_VAL, angle = 0;
    for (std::size_t t = 0; t < torus.triangles.size(); ++t) {
      nearest = std::min(nearest, norm(closest_on_triangle(p, torus.corners(t)) - p));
      angle += solid_angle(p, torus.corners(t));
    }
    const double winding = angle / (4 * 3.14159265358979323846);
    CHECK(std::sqrt(tree.closest(p).distance2) == Approx(nearest).epsilon(1e-12));
    CHECK(tree.winding_number(p, 0) == Approx(winding).margin(1e-10));
    CHECK(tree.winding_number(p, 2) == Approx(winding).margin(0.2));
    CHECK(tree.is_inside(p) == (winding > 0.5));
  }
}

TEST_CASE("the fast sign of a closed mesh is that of the winding number", "[dn_field]") {
  const Surface torus = make_torus(1, 0.4, 40);  // vertices on voxel lines: every tie-break is met
  const Field field = build_field(torus, grid_around(bounds(torus), 29, 0.2));
  const Bvh tree(torus);
  int wrong = 0;
  for_each_voxel(field.grid, [&](std::size_t at, Vec3 p) {
    if (at % 3 != 0) return;  // a lost crossing is wrong from there to the end of its line
    if (std::abs(field.distance[at]) > 1e-6F)
      wrong += (field.distance[at] < 0) != (tree.winding_number(p, 0) > 0.5);
  });
  CHECK(wrong == 0);
}

TEST_CASE("a mesh with a hole and one with flipped triangles keep their inside", "[dn_field]") {
  Surface holed = make_sphere(1, 16);
  holed.triangles.resize(holed.triangles.size() - 60);
  const Field field = build_field(holed, grid_around(bounds(holed), 21, 0.3));
  CHECK_FALSE(is_closed(holed));
  Surface flipped = make_sphere(1, 16);
  for (std::size_t t = 0; t < flipped.triangles.size(); t += 50)
    std::swap(flipped.triangles[t][0], flipped.triangles[t][1]);
  const Field turned = build_field(flipped, field.grid);
  for_each_voxel(field.grid, [&](std::size_t at, Vec3 p) {
    if (norm(p) < 0.75 && p.z < 0.3) CHECK(field.distance[at] < 0);
    if (norm(p) > 1.05) CHECK(field.distance[at] > 0);
    if (norm(p) < 0.75) CHECK(turned.distance[at] < 0);
    if (norm(p) > 1.05) CHECK(turned.distance[at] > 0);
  });
}

TEST_CASE("normals of a sphere are radial and of unit length", "[dn_field]") {
  const Surface sphere = make_sphere(1, 64);
  const Field field = build_field(sphere, grid_around(bounds(sphere), 24, 0.5));
  double worst = 0;
  for_each_voxel(field.grid, [&](std::size_t at, Vec3 p) {
    if (norm(p) < 0.3) return;  // near the medial axis the tessellation decides
    const Normal n = decode_normal(field.normal[at]);
    const Vec3 normal{static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)};
    CHECK(std::abs(norm(normal) - 1) < 1e-6);
    kit::worsen(worst, norm(normal - direction(p)));
  });
  CHECK(worst <
        0.06);  // half a facet's opening angle is 0.025, times 1/sqrt(2) … near a vertex twice that
}

TEST_CASE("beside degenerate triangles voxels of the surface have the normals of the others",
          "[dn_field]") {
  const Grid grid{{-1.5, -1.5, -1.5}, 0.25, {13, 13, 13}};  // centres on the box and on its edges
  const Surface box = make_box({1, 1, 1});
  const Field plain = build_field(box, grid);
  for (const std::size_t place : {std::size_t{0}, box.triangles.size()}) {
    Surface surface = box;
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    for (const double y : {-0.5, 0.0, 0.5}) surface.vertices.push_back({1, y, 0});
    surface.triangles.insert(surface.triangles.begin() + static_cast<std::ptrdiff_t>(place),
                             {first, first + 1, first + 2});
    const Field field = build_field(surface, grid);
    for (std::size_t at = 0; at < grid.size(); ++at)
      CHECK((field.normal[at] == no_normal) == (plain.normal[at] == no_normal));
    CHECK(dot(decoded(field.normal[grid.index(10, 6, 6)]), {1, 0, 0}) > 0.999);
  }
}

TEST_CASE("an encoded normal is met to 6.6e-5 rad", "[dn_field]") {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  for (int trial = 0; trial < 10000; ++trial) {
    const Vec3 n = direction({gauss(random), gauss(random), gauss(random)});
    const Normal d = decode_normal(encode_normal(n));
    const Vec3 back{static_cast<double>(d.x), static_cast<double>(d.y), static_cast<double>(d.z)};
    CHECK(norm(back - n) < 6.6e-5);
  }
  CHECK(encode_normal({}) == no_normal);
  CHECK(decode_normal(no_normal).x == 0);
}

TEST_CASE("a plate built two-sided has positive distances and opposite normals on its sides",
          "[dn_field]") {
  const Grid grid{{-1, -1, -0.95}, 0.1, {21, 21, 20}};
  const Field field = build_field(make_plate(0.8, 4), grid,
                                  {Sides::two, Content::distance_and_normal, HUGE_VAL, {}});
  CHECK(field.distance[grid.index(10, 10, 12)] == Approx(0.25));
  CHECK(field.distance[grid.index(10, 10, 7)] == Approx(0.25));
  CHECK(decode_normal(field.normal[grid.index(10, 10, 12)]).z == Approx(1));
  CHECK(decode_normal(field.normal[grid.index(10, 10, 7)]).z == Approx(-1));
}

TEST_CASE("a field cut off at its thickness agrees with the whole one within it", "[dn_field]") {
  const Surface torus = make_torus(1, 0.4, 32);
  const Grid grid = grid_around(bounds(torus), 32, 0.4);
  const Field whole = build_field(torus, grid);
  const Field thin = build_field(torus, grid, {Sides::one, Content::distance, 0.25, {}});
  CHECK(thin.normal.empty());
  int different = 0;
  for (std::size_t at = 0; at < grid.size(); ++at)
    different += thin.distance[at] != std::clamp(whole.distance[at], -cut_off(0.25), cut_off(0.25));
  CHECK(different == 0);
}

TEST_CASE("layers of voxels through rings of vertices have the sign of their place", "[dn_field]") {
  // The middle layer goes through the equator, up to rounding.
  struct Case {
    double radius;
    int n;
  };
  for (const auto [radius, n] : {Case{0.9, 63}, {0.9, 119}, {0.8, 111}, {0.1, 123}, {1, 21}}) {
    const Surface sphere = make_sphere(radius, 48);
    const Grid grid = grid_around(bounds(sphere), n, 0.5 * radius);
    const Field field =
        build_field(sphere, grid, {Sides::one, Content::distance, 0.5 * radius, {}});
    int n_inside = 0, wrong = 0;
    for_each_voxel(grid, [&](std::size_t at, Vec3 p) {
      const bool inside = norm(p) < 0.97 * radius;
      n_inside += inside ? 1 : 0;
      if (inside || norm(p) > radius) wrong += (field.distance[at] < 0) != inside ? 1 : 0;
    });
    INFO("radius " << radius << ", " << n << " voxels");
    CHECK(n_inside > n);
    CHECK(wrong == 0);
  }
}

TEST_CASE("real meshes: spot and env, the sign off the surface is that of the exact winding number",
          "[dn_field][.][shared_data]") {
  for (const auto* name : {"spot/spot.obj", "fcl/env.obj"}) {
    const Surface surface = read_obj(tess::test::shared_data(name));
    const Bvh tree(surface);
    const Grid grid = grid_around(bounds(surface), 14, 0.05 * norm(bounds(surface).size()));
    const Field field = build_field(surface, grid);
    int wrong = 0;
    for_each_voxel(grid, [&](std::size_t at, Vec3 p) {
      wrong += (field.distance[at] < 0) != (tree.winding_number(p, 0) > 0.5);
    });
    INFO(name << ", closed: " << is_closed(welded(surface)));
    CHECK(wrong == 0);
  }
}

TEST_CASE("bad surfaces and grids are refused with a reason", "[dn_field]") {
  const Grid grid{{0, 0, 0}, 0.1, {8, 8, 8}};
  CHECK_THROWS_AS(build_field({}, grid), tess::Error);
  Surface broken = make_box({1, 1, 1});
  broken.vertices[3].y = std::nan("");
  CHECK_THROWS_WITH(build_field(broken, grid), Contains("vertex 3"));
  broken.vertices[3].y = 1;
  broken.triangles[0][0] = 99;
  CHECK_THROWS_WITH(build_field(broken, grid), Contains("vertex 99 of 8"));
  CHECK_THROWS_AS(build_field(make_box({1, 1, 1}), grid, {Sides::one, Content::distance, 0.1, {}}),
                  tess::Error);
  CHECK_THROWS_AS(grid_around({{0, 0, 0}, {1, 1, 1}}, 100000, 0.1), tess::Error);
}

}  // namespace
