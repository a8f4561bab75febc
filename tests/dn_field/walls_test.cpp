#include "collide/dn_field/walls.hpp"

#include "collide/dn_field/shapes.hpp"
#include "tests/dn_field/field_samples.hpp"
#include "tests/support/catch.hpp"

#include <set>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

std::vector<double> thicknesses(const Surface& surface) {
  return wall_thicknesses(surface, Bvh(surface));
}

TEST_CASE("a segment crosses the triangles that brute force finds, at the same places",
          "[dn_field]") {
  const Surface surface = random_triangles(400, 5);
  const Bvh tree(surface);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> at(-1.5, 1.5);
  std::size_t n_found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 from{at(random), at(random), at(random)},
        to = trial % 5 == 0 ? from + Vec3{0, at(random), 0}
                            : Vec3{at(random), at(random), at(random)};
    std::vector<Crossing> crossings;
    tree.crossings(from, to, crossings);
    std::set<std::uint32_t> found, wanted;
    for (const Crossing& crossing : crossings) {
      found.insert(crossing.triangle);
      const Vec3 p = from + crossing.at * (to - from);
      CHECK(std::sqrt(tree.closest(p).distance2) < 1e-9);
    }
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      // By signed volumes: the ends on either side, and the way between all three edges.
      const auto [a, b, c] = surface.corners(t);
      const auto volume = [](Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
        return dot(cross(q - p, r - p), s - p);
      };
      const double begin = volume(a, b, c, from), end = volume(a, b, c, to);
      const std::array sides{
          volume(from, to, a, b), volume(from, to, b, c), volume(from, to, c, a)};
      const bool same = std::ranges::all_of(sides, [](double v) { return v > 0; }) ||
                        std::ranges::all_of(sides, [](double v) { return v < 0; });
      if (begin * end < 0 && same) wanted.insert(t);
    }
    CHECK(found == wanted);
    n_found += found.size();
  }
  CHECK(n_found > 100);
}

TEST_CASE("walls are as thick as they are", "[dn_field]") {
  // Faces of 4 × 4 a wall's thickness apart: 32 of the area 32 + 4 × 4 × thickness.
  for (const double thickness : {1e-4, 0.05, 0.3}) {
    const std::vector<double> plate = thicknesses(make_box({2, 2, 0.5 * thickness}));
    CHECK(plate.size() == 1024);
    CHECK(plate.front() == Approx(thickness).epsilon(0.001));
    CHECK(share_thinner(plate, 1.1 * thickness) ==
          Approx(32 / (32 + 16 * thickness)).margin(0.002));
    CHECK(share_thinner(plate, 0.9 * thickness) == 0);
    if (thickness > 0.01) CHECK(plate.back() == Approx(4).epsilon(0.01));
  }
  const std::vector<double> ball = thicknesses(make_sphere(1, 40));
  CHECK(ball.front() > 1.99);
  CHECK(ball.back() < 2.01);
}

TEST_CASE("an open sheet has no thickness, an edge is no wall, parts may overlap", "[dn_field]") {
  CHECK(thicknesses(make_plate(1, 4)).back() == 0);
  Surface lidless = without_last(make_box({1, 1, 1}), 2);
  CHECK(share_thinner(thicknesses(lidless), 0.5) < 0.05);  // near the rim, by the winding number
  // A pyramid: nothing looks the opposite way from a face, within 30 degrees.
  const Surface pyramid{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}},
                        {{3, 2, 1}, {3, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  CHECK(thicknesses(pyramid).front() == HUGE_VAL);
  // Two boxes, the second reaching half into the first: through both is one wall.
  Surface both = make_box({1, 1, 0.5}), second = make_box({1, 1, 0.5});
  for (const auto& triangle : second.triangles) {
    auto shifted = triangle;
    for (auto& v : shifted) v += static_cast<std::uint32_t>(both.vertices.size());
    both.triangles.push_back(shifted);
  }
  for (const Vec3 p : second.vertices) both.vertices.push_back(p + Vec3{0.01, 0.02, 0.5});
  const std::vector<double> joined = thicknesses(both);
  CHECK(share_thinner(joined, 1.4) < 0.45);  // faces inside of the other part see its far side
  CHECK(share_thinner(joined, 0.4) == 0);
  CHECK(thicknesses({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}).empty());
}

}  // namespace
