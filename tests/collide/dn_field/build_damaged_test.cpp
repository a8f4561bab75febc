#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/collide/dn_field/field_samples.hpp"
#include "tests/support/catch.hpp"

#include <random>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

/// All triangles the other way round.
Surface inverted(const Surface& surface) {
  return with_flipped(surface, 1);
}

/// The parts as one mesh, the second moved.
Surface joined(Surface surface, const Surface& other, Vec3 by = {}) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  for (const Vec3 p : other.vertices) surface.vertices.push_back(p + by);
  for (const auto& [a, b, c] : other.triangles)
    surface.triangles.push_back({first + a, first + b, first + c});
  return surface;
}

/// About the share `part` of all triangles the other way round.
Surface with_share_flipped(Surface surface, double part) {
  std::mt19937 random(5);
  for (auto& t : surface.triangles)
    if (std::uniform_real_distribution<double>(0, 1)(random) < part) std::swap(t[0], t[1]);
  return surface;
}

Field field_of(const Surface& surface, const Grid& grid, Method method) {
  const double thickness = 4 * grid.cell;
  if (method == Method::exact)
    return build_field(surface, grid, {Sides::one, Content::distance_and_normal, thickness, {}});
  return build_field(surface, grid,
                     {Sides::one, Content::distance_and_normal, thickness, method, {}});
}

TEST_CASE("a closed mesh turned inside out is what it bounds, normals too", "[dn_field]") {
  const Surface ball = make_sphere(1, 20), core = make_sphere(0.5, 14);
  const Surface shell = joined(ball, inverted(core)), two = joined(ball, core, {2, 0.3, 0.1});
  struct Case {
    Surface right, wrong;
  };
  for (const auto& [right, wrong] :
       {Case{ball, inverted(ball)}, Case{torn(ball, 0), inverted(torn(ball, 0))},
        Case{shell, inverted(shell)}, Case{two, inverted(two)}}) {
    const Grid grid = grid_around(bounds(right), 36, 0.4);
    for (const Method method : {Method::exact, Method::normals, Method::potential}) {
      const Field wanted = field_of(right, grid, method), found = field_of(wrong, grid, method);
      CHECK((found.distance == wanted.distance && found.normal == wanted.normal));
    }
  }
  const Grid grid = grid_around(bounds(shell), 35, 0.4);
  const Field hollow = field_of(shell, grid, Method::exact);
  CHECK(hollow.distance[grid.index(17, 17, 17)] > 0);
}

TEST_CASE("normals on a mesh turned inside out point out of it where they are the triangles' own",
          "[dn_field]") {
  const Surface box = inverted(make_box({0.5, 0.5, 0.5}));
  const Field field = build_field(box, {{-1, -1, -1}, 0.25, {9, 9, 9}});  // faces in voxel layers
  CHECK(decoded(field.normal[field.grid.index(6, 4, 4)]).x == Approx(1));
  CHECK(decoded(field.normal[field.grid.index(4, 2, 4)]).y == Approx(-1));
  CHECK(field.distance[field.grid.index(4, 4, 4)] == Approx(-0.5));
}

TEST_CASE("a mesh turned inside out stays what it bounds where some triangles were not",
          "[dn_field]") {
  const Surface mostly = inverted(with_flipped(make_sphere(1, 16), 10));
  const Field field = build_field(mostly, grid_around(bounds(mostly), 21, 0.3));
  int wrong = 0;
  for_each_voxel(field.grid, [&](std::size_t at, Vec3 p) {
    if (norm(p) < 0.75) wrong += field.distance[at] > 0;
    if (norm(p) > 1.1) wrong += field.distance[at] < 0;
  });
  CHECK(wrong == 0);
}

TEST_CASE("an open dish keeps its hollow outside, whichever way it faces", "[dn_field]") {
  const Surface dish = without_last(make_sphere(1, 16), 160);
  for (const Surface& surface : {inverted(dish), inverted(without_last(make_box({1, 1, 1}), 2))}) {
    const Field field = build_field(surface, grid_around(bounds(surface), 21, 0.3));
    int inside = 0;
    for_each_voxel(field.grid, [&](std::size_t at, Vec3 p) {
      inside += norm(p) < 0.8 && field.distance[at] < 0;
    });
    CHECK(inside == 0);
  }
}

TEST_CASE("however many triangles are flipped, the sign is the winding number's", "[dn_field]") {
  const Surface ball = make_sphere(1, 24);
  const Grid grid = grid_around(bounds(ball), 40, 0.4);
  const FieldOptions options{Sides::one, Content::distance, 3 * grid.cell, {}};
  for (const double part : {0.02, 0.1, 0.2, 0.3, 0.4}) {
    const Surface flipped = with_share_flipped(ball, part);
    const Field field = build_field(flipped, grid, options);
    const Bvh tree(flipped);
    int wrong = 0;
    for_each_voxel(grid, [&](std::size_t at, Vec3 p) {
      if (at % 41 != 0) return;
      const double w = tree.winding_number(p, 0);
      if (std::abs(w - 0.5) > 0.01) wrong += (field.distance[at] < 0) != (w > 0.5);
    });
    INFO("flipped " << part);
    CHECK(wrong == 0);
  }
}

TEST_CASE("the normals method refuses an object without thickness, and flipped triangles",
          "[dn_field]") {
  const auto refused = [](const Surface& surface) {
    const Grid grid = grid_around(bounds(surface), 30, 0.3);
    return message_of([&] { (void)field_of(surface, grid, Method::normals); });
  };
  const Surface ball = make_sphere(1, 24), plate = make_plate(1, 6);
  for (const Surface& bad :
       {plate, with_flipped(plate, 72), make_box({1, 1, 0.01}), with_share_flipped(ball, 0.45)})
    CHECK_THAT(refused(bad), Contains("% of the surface has no inside behind it"));
  CHECK(refused(ball).empty());
}

}  // namespace
