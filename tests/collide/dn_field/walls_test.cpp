#include "collide/dn_field/walls.hpp"

#include "collide/dn_field/shapes.hpp"
#include "tests/collide/dn_field/field_samples.hpp"
#include "tests/support/catch.hpp"

#include <set>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

double thin(const Surface& surface, double depth) {
  return thin_share(surface, Bvh(surface), depth);
}

/// Both, the second moved.
Surface beside(Surface one, const Surface& other, Vec3 by) {
  const auto n = static_cast<std::uint32_t>(one.vertices.size());
  for (const auto& t : other.triangles) one.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  for (const Vec3 p : other.vertices) one.vertices.push_back(p + by);
  return one;
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
      const std::array sides{volume(from, to, a, b), volume(from, to, b, c),
                             volume(from, to, c, a)};
      const bool same = std::ranges::all_of(sides, [](double v) { return v > 0; }) ||
                        std::ranges::all_of(sides, [](double v) { return v < 0; });
      if (begin * end < 0 && same) wanted.insert(t);
    }
    CHECK(found == wanted);
    n_found += found.size();
  }
  CHECK(n_found > 100);
}

TEST_CASE("the thin share of a body is that of its walls below the depth", "[dn_field]") {
  // Faces of 4 × 4 a wall's thickness apart: 32 of the area 32 + 4 × 4 × thickness.
  for (const double thickness : {1e-4, 0.05, 0.3}) {
    const Surface plate = make_box({2, 2, 0.5 * thickness});
    CHECK(thin(plate, 1.1 * thickness) == Approx(32 / (32 + 16 * thickness)).margin(0.002));
    CHECK(thin(plate, 0.9 * thickness) == 0);
  }
  CHECK(thin(make_sphere(1, 40), 1.9) < 0.01);
  CHECK(thin(make_sphere(1, 40), 2.1) == 1);
}

TEST_CASE("open sheets and sharp edges are thin, parts may overlap", "[dn_field]") {
  CHECK(thin(make_plate(1, 4), 1e-3) == 1);
  CHECK(thin(without_last(make_box({1, 1, 1}), 2), 0.1) < 0.1);  // near the rim
  const Surface pyramid{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}},
                        {{3, 2, 1}, {3, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
  CHECK(thin(pyramid, 0.1) == Approx(0.17).margin(0.04));  // its rim
  // Two boxes, the second reaching half into the first: through both is one wall.
  const Surface box = make_box({1, 1, 0.5});
  CHECK(thin(beside(box, box, {0.01, 0.02, 0.5}), 0.4) == 0);
}

}  // namespace
