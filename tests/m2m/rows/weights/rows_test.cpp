#include "m2m/rows/weights/rows.hpp"

#include "m2m/rows/search/nearest_vertex.hpp"
#include "m2m/rows/weights/point_rows.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <limits>

using namespace tess::m2m;

TEST_CASE("rows apply to several components; a row without columns gives zero", "[m2m][weights]") {
  Rows<double> rows;
  rows.add(2, 0.5);
  rows.add(0, 2.0);
  rows.end_row();
  rows.end_row();
  rows.add(1, 1.0);
  rows.end_row();
  const std::array<double, 6> values{1, 10, 2, 20, 3, NAN};
  std::vector<double> out(6, 7.0);
  apply(rows, values, 2, out);
  CHECK(out[0] == 3.5);
  CHECK(std::isnan(out[1]));
  CHECK(out[2] == 0);
  CHECK(out[4] == 2);
  std::vector<ValueRange> ranges(6);
  value_ranges(rows, values, 2, ranges);
  constexpr double inf = std::numeric_limits<double>::infinity();
  CHECK(ranges[0] == ValueRange{1, 3});
  CHECK(ranges[1] == ValueRange{10, 10});  // the NaN is left out
  CHECK(ranges[2] == ValueRange{inf, -inf});
}

TEST_CASE("rows of gradients give a vector per component", "[m2m][weights]") {
  Rows<Point> rows;
  rows.add(0, {-1, 0, 2});
  rows.add(1, {1, 3, 0});
  rows.end_row();
  const std::array<double, 4> values{1, 2, 5, 4};
  std::vector<Point> out(2);
  apply(rows, values, 2, out);
  CHECK(out[0] == Point{4, 15, 2});
  CHECK(out[1] == Point{2, 12, 4});
}

TEST_CASE("linear and nearest rows copy the value at a vertex", "[m2m][weights]") {
  const std::vector<Tet> tets{{0, 1, 2, 3}, {4, 3, 2, 1}};
  const std::vector<PointInTet> points{{1, {0, 0, 1, 0}}, {0, {0.25, 0.25, 0.25, 0.25}}};
  const Rows<double> linear = linear_rows(tets, points);
  CHECK(linear.columns == std::vector<VertexId>{2, 0, 1, 2, 3});
  const std::array<double, 5> values{4, 8, 0.1, 16, 5};
  std::vector<double> out(2);
  apply(linear, values, 1, out);
  CHECK(out == std::vector<double>{0.1, 0.25 * 4 + 0.25 * 8 + 0.25 * 0.1 + 0.25 * 16});
  const std::array<Point, 3> vertices{Point{0, 0, 0}, Point{1, 0, 0}, Point{2, 0, 0}};
  const NearestVertex search(vertices);
  const std::array<VertexId, 2> nearest{search.find({1.2, 0, 0}).vertex, -1};
  apply(nearest_rows(nearest), values, 1, out);
  CHECK(out == std::vector<double>{8, 0});
}
