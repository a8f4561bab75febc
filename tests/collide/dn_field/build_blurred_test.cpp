#include "apps/kit/worst.hpp"
#include "collide/dn_field/build/voxels.hpp"
#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/collide/dn_field/field_samples.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <set>
#include <thread>
#include <vector>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

TEST_CASE("the voxels of a surface are those its triangles cut", "[dn_field]") {
  const Surface sphere = make_sphere(1, 32);
  const Grid grid = grid_around(bounds(sphere), 24, 0.2);
  const auto voxels = surface_voxels(sphere, grid);
  std::vector<int> hit(grid.size(), 0);
  for (const SurfaceVoxel& v : voxels) ++hit[v.at];
  int wrong = 0;
  for_each_voxel(grid, [&](std::size_t at, Vec3 p) {
    const Vec3 n = direction(p);
    const double reach = 0.5 * grid.cell * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    const double off = std::abs(norm(p) - 1);
    if (off < 0.9 * reach - 0.005) wrong += hit[at] != 1;
    if (off > 1.1 * reach + 0.005) wrong += hit[at] != 0;
  });
  CHECK(wrong == 0);
}

TEST_CASE("a flat face between two layers of voxels meets both, wherever the grid stands",
          "[dn_field]") {
  for (const double aside : {0.0, 0.1, -7.3, 1e5})
    for (int n = 6; n <= 60; n += 2) {
      Surface plate = make_plate(1, 1);
      for (Vec3& p : plate.vertices) p += Vec3{aside, -aside, aside};
      const Grid grid = grid_around(bounds(plate), n, 0.4);
      const auto voxels = surface_voxels(plate, grid);
      const auto middle = grid.index(n / 2, n / 2, n / 2);
      int below = 0, above = 0;
      for (const SurfaceVoxel& v : voxels) {
        below += v.at == middle - grid.index(0, 0, 1);
        above += v.at == middle;
      }
      INFO("resolution " << n << ", aside " << aside);
      CHECK(below == 1);
      CHECK(above == 1);
    }
}

TEST_CASE("a plate between two layers is refused by normals and served by potential on both sides",
          "[dn_field]") {
  const Surface plate = make_plate(1, 1);
  for (const int n : {20, 21}) {
    const Grid grid = grid_around(bounds(plate), n, 0.4);
    CHECK_THROWS_WITH(
        build_field(plate, grid,
                    {Sides::one, Content::distance_and_normal, 0.4, Method::normals, {}}),
        Contains("near-zero thickness"));
    const Field field = build_field(
        plate, grid, {Sides::two, Content::distance_and_normal, 0.4, Method::potential, {}});
    for (const int k : {n / 2 - 2, n / 2 + 2})
      CHECK(decoded(field.normal[grid.index(n / 2, n / 2, k)]).z ==
            Approx(k < n / 2 ? -1 : 1).epsilon(0.01));
  }
  const Grid away{{5, 5, 5}, 0.1, {8, 8, 8}};
  for (const Method method : {Method::normals, Method::potential})
    CHECK_THROWS_WITH(build_field(make_box({1, 1, 1}), away,
                                  {Sides::one, Content::distance_and_normal, 0.4, method, {}}),
                      Contains("no voxel of the grid"));
}

/// The greatest and the mean angle to the exact normals of a sphere, in degrees, over all voxels
/// with one at least `core` from the middle.
std::pair<double, double> angles_off(const Field& field, double core) {
  double worst = 0, sum = 0;
  int count = 0;
  for_each_voxel(field.grid, [&](std::size_t at, Vec3 p) {
    if (field.normal[at] == no_normal || norm(p) < core) return;
    const double angle = angle_between(decoded(field.normal[at]), direction(p)) / degree;
    kit::worsen(worst, angle);
    sum += angle;
    ++count;
  });
  CHECK(count > 1000);
  return {worst, sum / count};
}

TEST_CASE("both of the paper's methods give a sphere's normals, and exact distances",
          "[dn_field]") {
  const Surface sphere = make_sphere(1, 48);
  const Grid grid = grid_around(bounds(sphere), 40, 0.4);
  const double thickness = 6 * grid.cell;
  const Field exact =
      build_field(sphere, grid, {Sides::one, Content::distance_and_normal, thickness, {}});
  for (const Method method : {Method::normals, Method::potential})
    for (const int radius : {2, 3, 4}) {
      const Blur blur{radius, 6 / radius + 1};
      const Field field = build_field(
          sphere, grid, {Sides::one, Content::distance_and_normal, thickness, method, blur});
      CHECK(field.method == method);
      CHECK(field.distance == exact.distance);
      int missing = 0;
      for (std::size_t at = 0; at < grid.size(); ++at)
        missing += (field.normal[at] == no_normal) != (exact.normal[at] == no_normal);
      CHECK(missing == 0);
      const auto [worst, mean] = angles_off(field, 0.3);
      INFO("method " << static_cast<int>(method) << " radius " << radius << ": worst " << worst
                     << "°, mean " << mean << "°");
      CHECK(worst < (method == Method::normals ? 6 : 22));
      CHECK(mean < (method == Method::normals ? 1.5 : 4));
    }
}

/// The mean of the values within a radius, with linear attenuation; beyond the grid they are 0.
std::vector<double> blurred(const Grid& grid, const std::vector<double>& values, int radius) {
  std::vector<double> result(values.size(), 0.0);
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        double sum = 0, weights = 0;
        for (int dk = -radius; dk <= radius; ++dk)
          for (int dj = -radius; dj <= radius; ++dj)
            for (int di = -radius; di <= radius; ++di) {
              const double weight = 1 - std::sqrt(di * di + dj * dj + dk * dk) / (radius + 1);
              if (di * di + dj * dj + dk * dk > radius * radius) continue;
              weights += weight;
              const int x = i + di, y = j + dj, z = k + dk;
              if (x >= 0 && x < grid.n[0] && y >= 0 && y < grid.n[1] && z >= 0 && z < grid.n[2])
                sum += weight * values[grid.index(x, y, z)];
            }
        result[grid.index(i, j, k)] = sum / weights;
      }
  return result;
}

TEST_CASE("normals by the potential are its slope, to one side at the grid's rim", "[dn_field]") {
  const Surface sphere = make_sphere(0.7, 24);
  const Grid grid{{-0.95, -0.95, -0.95}, 0.1, {20, 20, 14}};  // cuts the sphere
  const Blur blur{2, 3};
  const Field field = build_field(
      sphere, grid, {Sides::one, Content::distance_and_normal, 2, Method::potential, blur});
  const auto voxels = surface_voxels(sphere, grid);
  std::vector<double> potential(grid.size(), 0.0);
  const auto restore = [&] {
    for (const SurfaceVoxel& v : voxels) potential[v.at] = 1;
  };
  restore();
  for (int round = 0; round < blur.rounds; ++round) {
    potential = blurred(grid, potential, blur.radius);
    restore();
  }
  potential = blurred(grid, potential, 2);
  std::set<std::size_t> on_surface;
  for (const SurfaceVoxel& v : voxels) on_surface.insert(v.at);
  int n_rim = 0, n_inner = 0, wrong = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const std::size_t at = grid.index(i, j, k);
        if (on_surface.contains(at) || field.normal[at] == no_normal) continue;
        const std::array<int, 3> place{i, j, k};
        std::array<double, 3> slope{};
        bool rim = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          std::array<int, 3> up = place, down = place;
          up[axis] = std::min(place[axis] + 1, grid.n[axis] - 1);
          down[axis] = std::max(place[axis] - 1, 0);
          rim = rim || up[axis] - down[axis] == 1;
          slope[axis] = (potential[grid.index(down[0], down[1], down[2])] -
                         potential[grid.index(up[0], up[1], up[2])]) /
                        (up[axis] - down[axis]);
        }
        const double sign = field.distance[at] < 0 ? -1 : 1;
        const Vec3 want = sign * Vec3{slope[0], slope[1], slope[2]};
        if (norm(want) < 1e-6) continue;  // floats have few digits of it
        ++(rim ? n_rim : n_inner);
        wrong += angle_between(decoded(field.normal[at]), direction(want)) > 0.2 * degree ? 1 : 0;
      }
  CHECK(n_rim > 300);
  CHECK(n_inner > 1000);
  CHECK(wrong == 0);
}

TEST_CASE("a blurred field does not depend on how its layers are split", "[dn_field]") {
  const Surface torus = make_torus(1, 0.4, 24);
  const Grid grid = grid_around(bounds(torus), 26, 0.3);
  for (const Method method : {Method::normals, Method::potential}) {
    const FieldOptions options{Sides::one, Content::distance_and_normal, 0.3, method, {3, 2}};
    const Field whole = build_field(torus, grid, options);
    for (const std::vector<int>& cuts :
         {std::vector<int>{0, 26}, {0, 4, 4, 12, 26}, {0, 4, 8, 16, 24, 26}}) {
      FieldBuilder builder(torus, grid, options);
      const auto each_part = [&cuts](const auto& build) {
        std::vector<std::jthread> threads;
        for (std::size_t i = cuts.size() - 1; i > 0; --i)
          threads.emplace_back([&build, from = cuts[i - 1], to = cuts[i]] { build(from, to); });
      };
      CHECK(builder.n_rounds() == (method == Method::normals ? 4 : 5));
      for (int round = 0; round < builder.n_rounds(); ++round)
        each_part([&](int first, int last) { builder.build(round, first, last); });
      const Field field = builder.finish();
      CHECK(field.distance == whole.distance);
      CHECK(field.normal == whole.normal);
      CHECK(field.thickness == whole.thickness);
      CHECK(field.jump == whole.jump);
    }
  }
}

TEST_CASE("the potential of a thin plate points away from it on both sides", "[dn_field]") {
  const Grid grid{{-1, -1, -0.95}, 0.1, {21, 21, 20}};
  const Field field =
      build_field(make_plate(0.8, 4), grid,
                  {Sides::two, Content::distance_and_normal, 0.5, Method::potential, {}});
  for (const int k : {5, 6, 7, 8, 9, 10, 11, 12, 13, 14}) {
    const double away = k < 9.5 ? -1 : 1;
    CHECK(decoded(field.normal[grid.index(10, 10, k)]).z == Approx(away).epsilon(0.01));
    CHECK(field.distance[grid.index(10, 10, k)] > 0);
  }
}

TEST_CASE("normals away from a box turn smoothly: less from voxel to voxel than the exact ones",
          "[dn_field]") {
  const Surface box = make_box({0.5, 0.5, 0.5});
  const Grid grid = grid_around(bounds(box), 32, 0.4);
  const double thickness = 6 * grid.cell;
  const auto largest_turn = [&](const Field& field) {
    double most = 0;
    for (int k = 1; k < 31; ++k)
      for (int j = 1; j < 31; ++j)
        for (int i = 1; i < 31; ++i) {
          const auto at = grid.index(i, j, k), next = grid.index(i + 1, j, k);
          if (field.distance[at] > 0.5 * thickness || field.distance[at] < -2 * grid.cell ||
              field.distance[next] < -2 * grid.cell)
            continue;
          if (std::abs(field.distance[at]) < 2 * grid.cell) continue;
          if (field.normal[at] == no_normal || field.normal[next] == no_normal) continue;
          most =
              std::max(most, angle_between(decoded(field.normal[at]), decoded(field.normal[next])));
        }
    return most / degree;
  };
  const Field blurred = build_field(
      box, grid, {Sides::one, Content::distance_and_normal, thickness, Method::normals, {}});
  const Field exact =
      build_field(box, grid, {Sides::one, Content::distance_and_normal, thickness, {}});
  INFO("largest turn " << largest_turn(blurred) << "°, exact " << largest_turn(exact) << "°");
  CHECK(largest_turn(blurred) < largest_turn(exact));
}

TEST_CASE("the normals method refuses objects of near-zero thickness", "[dn_field]") {
  const auto built = [](const Surface& surface, int n, Method method, Sides sides) {
    const Grid grid = grid_around(bounds(surface), n, 0.3);
    return message_of([&] {
      (void)build_field(surface, grid,
                        {sides, Content::distance_and_normal, 3 * grid.cell, method, {}});
    });
  };
  CHECK_THAT(built(make_plate(1, 6), 24, Method::normals, Sides::one),
             Contains("near-zero thickness"));
  const Surface thin = make_box({1, 1, 0.01});
  CHECK_THAT(built(thin, 24, Method::normals, Sides::one), Contains("potential"));
  CHECK(built(thin, 24, Method::potential, Sides::two).empty());
  CHECK(built(make_box({1, 1, 0.5}), 24, Method::normals, Sides::one).empty());
  CHECK_THAT(built(make_box({1, 1, 0.5}), 24, Method::normals, Sides::two),
             Contains("only one side"));
}

TEST_CASE("a chosen blur reaches through the thickness, and one out of range is refused",
          "[dn_field]") {
  const Grid grid = grid_around({{-1, -1, -1}, {1, 1, 1}}, 41, 0.3);
  for (const double thickness : {0.1, 0.3, HUGE_VAL}) {
    const Blur blur = choose_blur(grid, thickness);
    CHECK(blur.radius * blur.rounds * grid.cell >= std::min(thickness, 2.0));
    CHECK_NOTHROW(require_blur(blur));
  }
  CHECK_THROWS_WITH(require_blur({5, 2}), Contains("2 to 4"));
  CHECK_THROWS_WITH(require_blur({3, 0}), Contains("at least one"));
}

}  // namespace
