#include "collide/dn_field/compressed.hpp"

#include "apps/kit/worst.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/look_up.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/collide/dn_field/field_samples.hpp"
#include "tests/support/catch.hpp"

#include <random>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

struct Columns {
  std::vector<float> x, y, z;
  explicit Columns(std::size_t n) : x(n), y(n), z(n) {}
};

/// The greatest differences at the centres of all voxels, seen through the look-ups.
ErrorBound worst_seen(const Field& flat, const Field& field) {
  const std::size_t n = flat.grid.size();
  Columns at(n), normal(n);
  for_each_voxel(flat.grid, [&](std::size_t v, Vec3 p) {
    at.x[v] = static_cast<float>(p.x);
    at.y[v] = static_cast<float>(p.y);
    at.z[v] = static_cast<float>(p.z);
  });
  std::vector<float> distance(n), alone(n);
  look_up(field, LookUp::nearest, {at.x, at.y, at.z}, {distance, {}, {}, {}});
  ErrorBound worst;
  for (std::size_t v = 0; v < n; ++v)
    kit::worsen(worst.distance, static_cast<double>(std::abs(distance[v] - flat.distance[v])));
  look_up(field, LookUp::nearest, {at.x, at.y, at.z}, {alone, normal.x, normal.y, normal.z});
  CHECK(alone == distance);
  Columns again(n);
  look_up(field, LookUp::nearest, {at.x, at.y, at.z}, {{}, again.x, again.y, again.z});
  CHECK((again.x == normal.x && again.y == normal.y && again.z == normal.z));
  for (std::size_t v = 0; v < n; ++v) {
    if (flat.normal[v] == no_normal) continue;
    const Vec3 found{static_cast<double>(normal.x[v]), static_cast<double>(normal.y[v]),
                     static_cast<double>(normal.z[v])};
    if (std::abs(norm(found) - 1) > 1e-6) worst.angle = HUGE_VAL;
    kit::worsen(worst.angle, angle_between(found, decoded(flat.normal[v])));
  }
  return worst;
}

TEST_CASE(
    "every voxel of a compressed field meets the bound, and the measured error is the true one",
    "[dn_field]") {
  const std::vector<Surface> shapes{make_sphere(1, 30), make_torus(1, 0.4, 40),
                                    make_box({1, 0.7, 0.5}), make_plate(1, 8)};
  for (const Surface& surface : shapes)
    for (const int n : {25, 30, 32})  // 30: cells of two voxels hold both sides of the plate
      for (const double cells : {3.0, HUGE_VAL}) {
        const Grid grid = grid_around(bounds(surface), n, 0.3);
        const Sides sides = surface.triangles.size() == 128 ? Sides::two : Sides::one;
        const Field flat = build_field(
            surface, grid, {sides, Content::distance_and_normal, cells * grid.cell, {}});
        for (const auto& [distance, angle] : {std::pair{0.2, 8.0}, {0.05, 2.0}, {0.01, 10.0}}) {
          const ErrorBound bound{distance * grid.cell, angle * degree};
          const Field field = compress(flat, bound);
          const ErrorBound seen = worst_seen(flat, field);
          INFO(surface.triangles.size() << " triangles, " << n << "³, " << cells << " cells, "
                                        << distance << " cells, " << angle << "°");
          CHECK(field.planes->measured.distance <= bound.distance);
          CHECK(field.planes->measured.angle <= bound.angle);
          CHECK(seen.distance <= field.planes->measured.distance + 1e-6 * grid.cell);
          CHECK(seen.angle <= field.planes->measured.angle + 1e-6);
          CHECK(seen.distance >= field.planes->measured.distance - 1e-6 * grid.cell);
          CHECK(seen.angle >= field.planes->measured.angle - 1e-6);
        }
      }
}

TEST_CASE("a compressed field is cut off where the flat one is, and has no normals there",
          "[dn_field]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-0.49, 0.49);
  const Surface shapes[] = {make_torus(1, 0.4, 64), make_sphere(1, 48), make_box({1, 0.7, 0.5})};
  for (const Surface& surface : shapes)
    for (const double thickness : {0.3, 0.5}) {
      const Grid grid = grid_around(bounds(surface), 60, thickness);
      const Field flat = build_field(surface, grid, {.thickness = thickness});
      const std::size_t n = grid.size();
      Columns at(n), normal(n);
      for_each_voxel(grid, [&](std::size_t v, Vec3 p) {
        at.x[v] = static_cast<float>(p.x + within(random) * grid.cell);
        at.y[v] = static_cast<float>(p.y + within(random) * grid.cell);
        at.z[v] = static_cast<float>(p.z + within(random) * grid.cell);
      });
      for (const auto& [cells, degrees] : {std::pair{0.125, 3.0}, {0.5, 20.0}}) {
        const Field field = compress(flat, {cells * grid.cell, degrees * degree});
        std::vector<float> distance(n);
        look_up(field, LookUp::tangent, {at.x, at.y, at.z},
                {distance, normal.x, normal.y, normal.z});
        std::size_t n_far = 0, n_nearer = 0, n_normals = 0, n_lost = 0;
        for (std::size_t v = 0; v < n; ++v) {
          const bool has = normal.x[v] != 0 || normal.y[v] != 0 || normal.z[v] != 0;
          if (flat.normal[v] != no_normal) {
            if (!has) ++n_lost;
          } else if (std::abs(flat.distance[v]) >= static_cast<float>(flat.thickness)) {
            ++n_far;
            if (std::abs(distance[v]) < static_cast<float>(flat.thickness)) ++n_nearer;
            if (has) ++n_normals;
          }
        }
        CAPTURE(surface.triangles.size(), thickness, cells);
        CHECK(n_far > n / 10);
        CHECK(n_nearer == 0);
        CHECK(n_normals == 0);
        CHECK(n_lost == 0);
      }
    }
}

TEST_CASE("a compressed field takes at most a fifth of the flat one's memory", "[dn_field]") {
  for (const Surface& surface :
       {make_sphere(1, 60), make_torus(1, 0.4, 80), make_box({1, 0.7, 0.5})}) {
    const Grid grid = grid_around(bounds(surface), 60, 0.3);
    const Field flat =
        build_field(surface, grid, {Sides::one, Content::distance_and_normal, 4 * grid.cell, {}});
    const Field field = compress(flat, {0.05 * grid.cell, 2 * degree});
    INFO(flat.bytes() << " bytes flat, " << field.bytes() << " compressed");
    CHECK(5 * field.bytes() <= flat.bytes());
  }
}

TEST_CASE("a compressed look-up is that of the nearest voxel, and out of reach outside and for NaN",
          "[dn_field]") {
  const Surface torus = make_torus(1, 0.4, 40);
  const Grid grid = grid_around(bounds(torus), 30, 0.3);
  const Field flat = build_field(torus, grid);
  const ErrorBound bound{0.05 * grid.cell, 3 * degree};
  for (const int block_shift : {2, 3, 4}) {
    const Field field = compress(flat, bound, block_shift);
    CHECK(field.planes->block_shift == block_shift);
    const std::size_t n = 5001;
    Columns at(n), normal(n);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> anywhere(-2, 2);
    for (std::size_t p = 0; p < n; ++p)
      at.x[p] = anywhere(random), at.y[p] = anywhere(random), at.z[p] = anywhere(random);
    at.y[n - 1] = std::nanf("");
    std::vector<float> expected(n), found(n);
    look_up(flat, LookUp::nearest, {at.x, at.y, at.z}, {expected, {}, {}, {}});
    look_up(field, LookUp::nearest, {at.x, at.y, at.z}, {found, normal.x, normal.y, normal.z});
    int wrong = 0, outside = 0;
    for (std::size_t p = 0; p < n; ++p) {
      outside += expected[p] == out_of_reach;
      if (expected[p] == out_of_reach)
        wrong += found[p] != out_of_reach || normal.x[p] != 0 || normal.y[p] != 0;
      else
        wrong += std::abs(found[p] - expected[p]) > static_cast<float>(bound.distance);
    }
    CHECK(wrong == 0);
    CHECK(outside > 1000);
    CHECK(found[n - 1] == out_of_reach);
  }
}

TEST_CASE("without a block_shift a field gets the blocks that take least memory", "[dn_field]") {
  const Surface ball = make_sphere(1, 30), speck = make_sphere(0.1, 24);
  // The speck's part of the last grid lies in one block of 16³ voxels.
  constexpr double cell = 0.04;
  const auto best_for = [](const Surface& surface, const Grid& grid, double thickness) {
    const Field flat = build_field(surface, grid, {.thickness = thickness});
    const ErrorBound bound{0.125 * grid.cell, 3 * degree};
    std::size_t least = flat.bytes();
    int best = 0;
    for (const int shift : {2, 3, 4}) {
      const std::size_t bytes = compress(flat, bound, shift).bytes();
      if (bytes < least) least = bytes, best = shift;
    }
    CHECK(compress(flat, bound).bytes() == least);
    return best;
  };
  CHECK(best_for(ball, grid_around(bounds(ball), 40, 0.5), 0.5) == 2);
  CHECK(best_for(speck, grid_around(bounds(speck), 96, 1), 0.06) == 3);
  CHECK(best_for(speck, {-40 * cell * Vec3{1, 1, 1}, cell, {96, 96, 96}}, 0.1) == 4);
}

TEST_CASE("bounds that mean nothing, or that no entry meets, are refused", "[dn_field]") {
  const Surface box = make_box({1, 1, 1});
  const Field flat = build_field(box, grid_around(bounds(box), 12, 0.5));
  CHECK_THROWS_WITH(compress(flat, {-1, 0.1}), Contains("distance -1"));
  CHECK_FALSE(message_of([&] { (void)compress(flat, {0.1, std::nan("")}); }).empty());
  CHECK_THROWS_WITH(compress(flat, {1e-9, 0.1}), Contains("32 bits"));
  CHECK_THROWS_WITH(compress(flat, {0.1, 0.1}, 7), Contains("2^7"));
}

}  // namespace
