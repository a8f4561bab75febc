#include "m2m/rows/interpolate/locate.hpp"

#include "m2m/kuhn.hpp"
#include "m2m/rows/interpolate/orientation.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>

using namespace tess::m2m;

namespace {

const std::array<Point, 4> unit{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};

bool same_bits(const Location& a, const Location& b) {
  return a.weights == b.weights && a.distance == b.distance && a.status == b.status &&
         a.place == b.place;
}

}  // namespace

TEST_CASE("points inside, on the boundary, snapped and outside are distinguished",
          "[m2m][locate]") {
  const auto status = [](Point p) {
    const auto found = locate(p, unit);
    return found ? found->status : Status::outside;
  };
  CHECK(status({0.25, 0.25, 0.25}) == Status::inside);
  CHECK(status({1e-300, 0.25, 0.25}) == Status::inside);
  CHECK(status({0, 0.25, 0.25}) == Status::boundary);
  CHECK(status({0, 0, 0.25}) == Status::boundary);
  CHECK(status({0, 0, 1}) == Status::boundary);
  CHECK(status({0.5, 0.25, 0.25}) == Status::boundary);
  CHECK(status({-1e-300, 0.25, 0.25}) == Status::snapped);
  CHECK(status({0.5, 0.25, std::nextafter(0.25, 1)}) == Status::snapped);
  CHECK(status({-1.3e-10, 0.25, 0.25}) == Status::snapped);
  CHECK(status({-1.6e-10, 0.25, 0.25}) == Status::outside);
  CHECK(status({5, 5, 5}) == Status::outside);
  const auto corner = locate({0, 1, 0}, unit);
  REQUIRE(corner);
  CHECK(corner->weights == Weights{0, 0, 1, 0});
  CHECK(corner->place == Place::corner);
  CHECK(locate({0, 0.25, 0.25}, unit)->place == Place::elsewhere);
}

TEST_CASE("a corner of weight 0 gives nothing of its value, be it NaN or infinite",
          "[m2m][locate]") {
  const auto found = locate({0.25, 0.25, 0}, unit);  // on the face without the last corner
  REQUIRE(found);
  REQUIRE(found->weights[3] == 0);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    const std::array<double, 4> values{1, 2, 3, bad};
    CHECK(interpolated(found->weights, {0, 1, 2, 3}, values.data(), 1) == 1.75);
    CHECK(!std::isfinite(interpolated({0.5, 0.25, 0, 0.25}, {0, 1, 2, 3}, values.data(), 1)));
  }
}

TEST_CASE("a tetrahedron without volume holds only its corners", "[m2m][locate]") {
  const std::array<Point, 4> flat{Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}, Point{1, 1, 0}};
  CHECK(locate({1, 1, 0}, flat).has_value());
  CHECK_FALSE(locate({0.25, 0.25, 0}, flat).has_value());
  const std::array<Point, 4> twice{Point{0, 0, 0}, Point{1, 0, 0}, Point{1, 0, 0}, Point{0, 0, 1}};
  CHECK_FALSE(locate({0.25, 0, 0.25}, twice).has_value());
}

TEST_CASE("a point beside a nearly flat tetrahedron snaps without extrapolating", "[m2m][locate]") {
  tess::Random random(5);
  int n_snapped = 0, n_to_flattest = 0;
  for (int k = 0; k < 4000; ++k) {
    const double height = k % 4 == 0 ? 0 : std::pow(10, -17 + 14 * random.unit());
    const double above = std::pow(10, -16 + 5 * random.unit());
    // On a slanted plane, whose coordinates are rounded.
    const auto at = [](double x, double y, double z) {
      return Point{0.36 * x + 0.48 * y + 0.8 * z, -0.8 * x + 0.6 * y,
                   -0.48 * x - 0.64 * y + 0.6 * z};
    };
    const std::array<Point, 4> corners{at(0, 0, 0), at(1, 0, 0), at(0.2, 1, 0), at(1, 1, -height)};
    const Point p = at(random.unit(), random.unit(), above);
    const auto found = locate(p, corners);
    if (found && found->status == Status::snapped) {
      ++n_snapped;
      if (height < 1e-15) ++n_to_flattest;
      const auto [least, most] = std::minmax_element(found->weights.begin(), found->weights.end());
      REQUIRE(*least >= -1e-6);
      REQUIRE(*most <= 1 + 3e-6);
      Point there{};
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
          there[axis] += found->weights[i] * corners[i][axis];
      for (std::size_t axis = 0; axis < 3; ++axis)
        REQUIRE(std::abs(there[axis] - p[axis]) <= 1.001 * found->distance + 1e-14);
    }
    // The same at scales whose squared areas leave the range of double.
    for (const int exponent : {-260, 300}) {
      const auto scaled = [&](Point q) {
        for (double& x : q) x = std::ldexp(x, exponent);
        return q;
      };
      std::array<Point, 4> there = corners;
      for (Point& corner : there) corner = scaled(corner);
      const auto again = locate(scaled(p), there);
      REQUIRE(again.has_value() == found.has_value());
      if (found) REQUIRE(again->weights == found->weights);
    }
  }
  CHECK(n_snapped > 1000);
  CHECK(n_to_flattest > 200);
}

TEST_CASE("the sign of a volume is exact even if it is smaller than the rounding error",
          "[m2m][locate]") {
  // q deviates from the line a b by i ulps. The volume has the sign of i, and is far smaller than
  // the rounding errors of the products.
  const Point a{12, 12, 0}, b{24, 0, 0}, up{12, 12, 1};
  const auto sign = [](double x) { return (x > 0) - (x < 0); };
  for (int i = -8; i <= 8; ++i) {
    const Point q{8 + std::ldexp(i, i < 0 ? -50 : -49), 16, 0};
    CAPTURE(i);
    CHECK(sign(orientation(q, a, b, up)) == sign(i));
    CHECK(sign(orientation_exact(q, a, b, up)) == sign(i));
    CHECK(orientation(q, a, b, {1, 2, 0}) == 0);  // all in z = 0
  }
}

TEST_CASE("weights reproduce random points, and every point of a box has a tetrahedron",
          "[m2m][locate]") {
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 500; ++i) {
    const Point p{uniform(random), uniform(random), uniform(random)};
    int holders = 0;
    for (const Tet& tet : mesh.tets) {
      const auto corners = corners_of(mesh.points, tet);
      const auto found = locate(p, corners);
      if (!found) continue;
      ++holders;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        double back = 0;
        for (std::size_t k = 0; k < 4; ++k) back += found->weights[k] * corners[k][axis];
        CHECK(std::abs(back - p[axis]) < 1e-15 * 8);
      }
    }
    CHECK(holders >= 1);
  }
}

TEST_CASE("a batch gives the same bits as single calls", "[m2m][locate]") {
  for (const double flatness : {1.0, 1e-4, 1e-9}) {
    TetMesh mesh = kuhn_mesh({4, 0.2}), queries = kuhn_mesh({5, 0.1});
    const TetMesh coincident = kuhn_mesh({4});
    queries.points.insert(queries.points.end(), mesh.points.begin(), mesh.points.end());
    queries.points.insert(queries.points.end(), coincident.points.begin(), coincident.points.end());
    for (TetMesh* m : {&mesh, &queries})
      for (Point& p : m->points) p = {p[0], p[1] - p[2] * flatness, p[1] + p[2] * flatness};
    std::vector<PointPair> pairs;
    for (std::size_t t = 0; t < mesh.n_tets(); ++t)
      for (std::size_t q = 0; q < queries.n_points(); ++q)
        pairs.push_back({static_cast<std::int32_t>(t), static_cast<std::int32_t>(q)});
    std::vector<Found> found;
    locate_pairs(mesh.points, mesh.tets, queries.points, pairs, found);
    std::size_t next = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto alone =
          locate(queries.points[static_cast<std::size_t>(pairs[i].point)],
                 corners_of(mesh.points, mesh.tets[static_cast<std::size_t>(pairs[i].tet)]));
      const bool in_batch = next < found.size() && static_cast<std::size_t>(found[next].pair) == i;
      if (alone.has_value() != in_batch || (alone && !same_bits(*alone, found[next].location)))
        FAIL("pair " << i);
      next += in_batch;
    }
    CHECK(next == found.size());
  }
}

TEST_CASE("weights of flat rotated tetrahedra are within 1e-12", "[m2m][locate]") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double height : {1.0, 1e-4, 1e-8}) {
    int n_found = 0;
    for (int i = 0; i < 200; ++i) {
      std::array<Point, 4> corners;
      for (Point& p : corners) {
        const double u = uniform(random), v = uniform(random), w = height * uniform(random);
        p = {u + w, v - w, 0.6 * u + 0.3 * v + w};
      }
      Weights wanted{0.4, 0.3, 0.2, 0.1};
      Point p{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < 4; ++k) p[axis] += wanted[k] * corners[k][axis];
      // The weights of the rounded p, from exact volumes.
      Weights exact{orientation_exact(p, corners[1], corners[2], corners[3]),
                    orientation_exact(p, corners[0], corners[3], corners[2]),
                    orientation_exact(p, corners[0], corners[1], corners[3]),
                    orientation_exact(p, corners[0], corners[2], corners[1])};
      const double total = exact[0] + exact[1] + exact[2] + exact[3];
      const auto found = locate(p, corners);
      if (!found) continue;  // flatter than the rounding error of p
      ++n_found;
      for (std::size_t k = 0; k < 4; ++k)
        CHECK(std::abs(found->weights[k] - exact[k] / total) < 1e-12);
    }
    CAPTURE(height);
    CHECK(n_found > 190);
  }
}

TEST_CASE("the best candidate does not depend on the order of merging", "[m2m][locate]") {
  std::vector<Candidate> all{{0, 9, Status::inside},
                             {0, 4, Status::boundary},
                             {1e-14, 1, Status::snapped},
                             {0, 7, Status::boundary},
                             {}};
  std::sort(all.begin(), all.end(),
            [](const Candidate& a, const Candidate& b) { return a.tet < b.tet; });
  do {
    Candidate best;
    for (const Candidate& candidate : all) best = better(candidate, best) ? candidate : best;
    CHECK(best.tet == 4);
  } while (
      std::next_permutation(all.begin(), all.end(),
                            [](const Candidate& a, const Candidate& b) { return a.tet < b.tet; }));
}
