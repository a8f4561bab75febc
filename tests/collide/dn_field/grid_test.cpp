#include "collide/dn_field/grid.hpp"

#include "collide/dn_field/shapes.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"

namespace {

using namespace tess::dn;

TEST_CASE("a grid around a box is cubic, centred, and leaves the margin free", "[dn_field][grid]") {
  const Bounds box{{-1, 0, 2}, {3, 1, 2.5}};
  const Grid grid = grid_around(box, 41, 0.5);
  const Vec3 last = grid.centre(40, 40, 40), middle = 0.5 * (grid.origin + last);
  CHECK(norm(middle - box.centre()) < 1e-12);
  CHECK(grid.origin.x <= box.low.x - 0.5 + 1e-12);
  CHECK(last.x >= box.high.x + 0.5 - 1e-12);
  CHECK(grid.size() == 41 * 41 * 41);
  CHECK(grid.index(1, 0, 0) == 1);
  CHECK(grid.index(0, 1, 0) == 41);
  CHECK(grid.index(40, 40, 40) == grid.size() - 1);
}

TEST_CASE("a grid that cannot be is refused", "[dn_field][grid]") {
  const Bounds box{{0, 0, 0}, {1, 1, 1}};
  CHECK_THROWS_AS(grid_around(box, 3, 0.1), tess::Error);
  CHECK_THROWS_AS(grid_around(box, 20, -1), tess::Error);
  CHECK_THROWS_AS(grid_around({{0, 0, 0}, {0, 0, 0}}, 20, 0.1), tess::Error);
  CHECK_THROWS_AS(grid_around(box, 8, 100), tess::Error);
}

TEST_CASE("a welded triangle soup is closed where the soup was not", "[dn_field][surface]") {
  const Surface box = make_box({1, 2, 3});
  Surface soup;
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const Vec3 corner : box.corners(t)) soup.vertices.push_back(corner);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  CHECK_FALSE(is_closed(soup));
  const Surface whole = welded(soup);
  CHECK(is_closed(whole));
  CHECK(whole.vertices.size() == 8);
  REQUIRE(whole.triangles.size() == 12);
  for (std::size_t t = 0; t < 12; ++t) CHECK(whole.corners(t) == box.corners(t));
  soup.vertices[4].x += 1e-9;  // not bit-equal: the seam stays open
  CHECK_FALSE(is_closed(welded(soup)));
}

}  // namespace
