// The sample of collide/guide/nearest_and_rays.md, compiled and run. check.py compares the text.
#include "collide/queries.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <optional>
#include <vector>

using namespace tess::collide;

TEST_CASE("the sample of spatial queries finds near triangles, and what is below", "[sample]") {
  std::vector<Triangle> triangles;  // one above the other
  for (int i = 0; i < 8; ++i)
    triangles.push_back({{{{0, 0, 1.0 * i}, {4, 0, 1.0 * i}, {0, 4, 1.0 * i}}}});
  const Point point{1, 1, 2.25};
  std::vector<double> distances;
  const Index index{std::span<const Triangle>(triangles)};
  for (const Neighbour& n : index.nearest(point, 3)) distances.push_back(std::sqrt(n.distance2));
  const std::optional<RayHit> below = index.first_hit({.from = point, .direction = {0, 0, -1}});
  REQUIRE(distances.size() == 3);
  CHECK(distances[0] == Approx(0.25));
  CHECK(distances[2] == Approx(1.25));
  REQUIRE(below);
  CHECK(below->object == 2);
  CHECK(below->at == Approx(0.25));
  CHECK(Index<Triangle>({}).nearest(point, 3).empty());
}
