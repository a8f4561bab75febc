#include "apps/kit/worst.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/collide/dn_field/field_samples.hpp"
#include "tests/collide/dn_field/triangle_distance.hpp"
#include "tests/support/catch.hpp"

#include <thread>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

double brute_force(const Surface& surface, Vec3 p) {
  double nearest = HUGE_VAL;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    // The edges too: the closest point of a needle's face is rounding.
    const auto [a, b, c] = surface.corners(t);
    for (const auto& part : {std::array{a, b, c}, {a, b, b}, {b, c, c}, {c, a, a}})
      if (const Vec3 q = closest_on_triangle(p, part); is_finite(q))
        nearest = std::min(nearest, norm(q - p));
  }
  return nearest;
}

TEST_CASE("distances to any triangles, degenerate ones too, are those of brute force",
          "[dn_field]") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Surface surface = random_triangles(60, seed);
    const Grid grid = grid_around(bounds(surface), 14, 0.2);
    const double thickness = seed == 1 ? HUGE_VAL : 2.5 * grid.cell;
    const Field field =
        build_field(surface, grid, {Sides::two, Content::distance_and_normal, thickness, {}});
    double worst = 0;
    for_each_voxel(grid, [&](std::size_t at, Vec3 p) {
      const double truth =
          std::min(brute_force(surface, p), static_cast<double>(cut_off(thickness)));
      kit::worsen(worst, std::abs(static_cast<double>(field.distance[at]) - truth));
    });
    INFO("seed " << seed);
    CHECK(worst < 3e-7);
  }
}

TEST_CASE("a field does not depend on how its layers are split, in which order, on which thread",
          "[dn_field]") {
  const Surface surface = with_flipped(without_last(make_torus(1, 0.4, 30), 40), 37);
  const Grid grid = grid_around(bounds(surface), 27, 0.3);
  for (const double thickness : {HUGE_VAL, 3 * grid.cell}) {
    const FieldOptions options{Sides::one, Content::distance_and_normal, thickness, {}};
    const Field whole = build_field(surface, grid, options);
    for (const auto& cuts : {std::vector{0, 27}, {0, 4, 8, 16, 27}, {0, 8, 16, 27}}) {
      FieldBuilder builder(surface, grid, options);
      std::vector<std::jthread> threads;
      for (std::size_t c = cuts.size() - 1; c > 0; --c)
        threads.emplace_back([&, c] { builder.build(0, cuts[c - 1], cuts[c]); });
      threads.clear();
      const Field field = builder.finish();
      CHECK(field.distance == whole.distance);
      CHECK(field.normal == whole.normal);
      CHECK(field.thickness == whole.thickness);
      CHECK(field.jump == greatest_jump(whole));
    }
  }
}

TEST_CASE("the sign of open, flipped and torn meshes is that of the exact winding number",
          "[dn_field]") {
  const Surface torus = make_torus(1, 0.4, 28);
  for (const Surface& surface :
       {without_last(torus, 300), with_flipped(torus, 20), torn(torus, 2e-3), torn(torus, 0),
        without_last(make_sphere(1, 16), 256), without_last(make_box({1, 0.7, 0.5}), 2),
        make_plate(1, 6)}) {
    const Grid grid = grid_around(bounds(surface), 15, 0.25);
    const Bvh tree(surface);
    const Field field = build_field(surface, grid);
    int wrong = 0, inside = 0;
    for_each_voxel(grid, [&](std::size_t at, Vec3 p) {
      const double w = tree.winding_number(p, 0);
      inside += w > 0.5;
      if (std::abs(field.distance[at]) < 1e-9F) return;  // on the surface: neither side
      if (std::abs(w - 0.5) > 0.01) wrong += (field.distance[at] < 0) != (w > 0.5);
    });
    INFO(surface.triangles.size() << " triangles, " << inside << " voxels inside");
    CHECK(wrong == 0);
  }
}

TEST_CASE("a field of a mesh twenty doublings larger or smaller is the same field, scaled",
          "[dn_field]") {
  const Surface surface = with_flipped(without_last(make_torus(1, 0.4, 24), 60), 31);
  const Grid grid = grid_around(bounds(surface), 20, 0.3);
  const Field field = build_field(surface, grid);
  for (const int doublings : {-20, 20}) {
    const double scale = std::ldexp(1.0, doublings);
    Surface scaled = surface;
    for (Vec3& p : scaled.vertices) p = scale * p;
    const Field other = build_field(scaled, {scale * grid.origin, scale * grid.cell, grid.n});
    int different = 0;
    for (std::size_t at = 0; at < grid.size(); ++at)
      different += other.distance[at] != std::ldexp(field.distance[at], doublings);
    CHECK(different == 0);
    CHECK(other.normal == field.normal);
  }
}

TEST_CASE("beyond its thickness a field is a lower bound of the distance, with the right sign",
          "[dn_field]") {
  const Surface surface = make_sphere(1, 24);
  const Grid grid = grid_around(bounds(surface), 30, 0.4);
  const Field field =
      build_field(surface, grid, {Sides::one, Content::distance, 2.5 * grid.cell, {}});
  int wrong = 0;
  for_each_voxel(grid, [&](std::size_t at, Vec3 p) {
    const double truth = norm(p) - 1, found = static_cast<double>(field.distance[at]);
    if (std::abs(truth) < 0.01) return;
    wrong += (found < 0) != (truth < 0) || std::abs(found) > std::abs(truth) + 0.01;
  });
  CHECK(wrong == 0);
}

TEST_CASE("off the medial axis the distance between voxels converges with order 2", "[dn_field]") {
  const auto worst_error = [](bool sphere, int n) {
    const Surface surface = sphere ? make_sphere(1, 2 * n) : make_torus(1, 0.45, 4 * n);
    const Field field = build_field(surface, grid_around(bounds(surface), n, 0.25),
                                    {Sides::one, Content::distance, 0.8, {}});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> at(-1.4, 1.4);
    double worst = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      const Vec3 p{at(random), at(random), 0.4 * at(random)};
      const double ring = std::hypot(p.x, p.y);
      const double truth = sphere ? norm(p) - 1 : std::hypot(ring - 1, p.z) - 0.45;
      if (std::abs(truth) > 0.2) continue;  // the medial axis is a point, a circle, a line: far
      const Vec3 g = (1 / field.grid.cell) * (p - field.grid.origin);
      if (g.x < 0 || g.y < 0 || g.z < 0 || g.x >= n - 1 || g.y >= n - 1 || g.z >= n - 1) continue;
      kit::worsen(worst, std::abs(trilinear(field, p) - truth));
    }
    return worst;
  };
  for (const bool sphere : {true, false}) {
    const double coarse = worst_error(sphere, 10), middle = worst_error(sphere, 20),
                 fine = worst_error(sphere, 40);
    INFO("errors " << coarse << ", " << middle << ", " << fine);
    CHECK(std::log2(coarse / middle) > 1.7);
    CHECK(std::log2(middle / fine) == Approx(2).margin(0.3));
  }
}

TEST_CASE("grids that cannot be built are refused in one line", "[dn_field]") {
  const Surface box = make_box({1, 1, 1});
  const auto refused = [&](const Grid& grid) {
    const std::string message = message_of([&] { (void)build_field(box, grid); });
    CHECK(message.find('\n') == std::string::npos);
    return message;
  };
  CHECK_THAT(refused({{0, 0, 0}, 1e-6, {1 << 20, 1 << 20, 1 << 20}}), Contains("GB"));
  CHECK_THAT(refused({{0, 0, 0}, 0, {8, 8, 8}}), Contains("cells of 0"));
  CHECK_THAT(refused({{0, std::nan(""), 0}, 0.1, {8, 8, 8}}), Contains("finite"));
  CHECK_THAT(refused({{0, 0, 0}, 0.1, {8, 0, 8}}), Contains("8 × 0 × 8"));
  Surface flat = box;
  for (Vec3& p : flat.vertices) p = 0.0 * p;
  CHECK_THROWS_WITH(build_field(flat, {{0, 0, 0}, 0.1, {8, 8, 8}}), Contains("extent 0"));
}

}  // namespace
