#include "m2m/rows/reconstruct/second_order.hpp"

#include "apps/kit/worst.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/rows/reconstruct/gradients.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <set>

using namespace tess::m2m;
using tess::test::ball, tess::test::place_points, tess::test::sampled, tess::test::smooth,
    tess::test::Values, tess::test::view;

namespace {

/// The boundary of the cube stays; inside, vertices move smoothly, beside the jitter.
TetMesh distorted(std::int32_t n, double jitter) {
  TetMesh mesh = kuhn_mesh({n, jitter});
  for (Point& p : mesh.points) {
    const double bump = 8 * p[0] * (1 - p[0]) * p[1] * (1 - p[1]) * p[2] * (1 - p[2]);
    p = {p[0] + 0.4 * bump, p[1] - 0.3 * bump, p[2] + 0.2 * bump};
  }
  return mesh;
}

Values second_order(const TetMesh& source, std::span<const PointInTet> at, const Values& values,
                    Limit limit = Limit::none) {
  const Rows<Point> rows = gradient_rows(view(source));
  std::vector<Point> gradients(rows.n_rows());
  apply(rows, values, 1, gradients);
  const auto ranges =
      limit == Limit::patch ? vertex_ranges(view(source), values, 1) : std::vector<ValueRange>{};
  Values out(at.size());
  second_order_values(view(source), at, values, gradients, 1, limit, ranges, out);
  return out;
}

double rms(const Values& got, const Values& want) {
  double squared = 0;
  for (std::size_t i = 0; i < got.size(); ++i) squared += (got[i] - want[i]) * (got[i] - want[i]);
  return std::sqrt(squared / static_cast<double>(got.size()));
}

/// The mean order over a series of halved lengths.
double order_of(const Values& errors) {
  return std::log2(errors.front() / errors.back()) / static_cast<double>(errors.size() - 1);
}

}  // namespace

TEST_CASE("order 2.8 or better by recovered gradients, 2.0 by linear interpolation",
          "[m2m][reconstruct]") {
  for (const bool bent : {false, true}) {
    Values second, linear, second_worst;
    for (const std::int32_t n : {3, 6, 12, 24}) {
      const TetMesh source = bent ? distorted(n, 0.15) : kuhn_mesh({n});
      const TetMesh target = bent ? distorted(n + 3, 0.1) : kuhn_mesh({n + 3});
      const auto at = place_points(view(source), target.points);
      const Values values = sampled(source.points, smooth), want = sampled(target.points, smooth);
      const Values got = second_order(source, at, values);
      Values by_rows(at.size());
      apply(linear_rows(source.tets, at), values, 1, by_rows);
      second.push_back(rms(got, want));
      linear.push_back(rms(by_rows, want));
      double worst = 0;
      for (std::size_t i = 0; i < got.size(); ++i) kit::worsen(worst, std::abs(got[i] - want[i]));
      second_worst.push_back(worst);
    }
    CAPTURE(bent, second, linear, second_worst);
    CHECK(order_of(second) > 2.8);
    CHECK(order_of(second_worst) > 2.8);
    CHECK(std::abs(order_of(linear) - 2.0) < 0.1);
    CHECK(second.back() < 0.05 * linear.back());
  }
}

TEST_CASE("quadratic fields are exact, and rows give the values", "[m2m][reconstruct]") {
  const auto f = [](const Point& p) { return 1 - p[0] + p[0] * p[1] + 2 * p[2] * p[2]; };
  const TetMesh source = kuhn_mesh({4, 0.2}), target = kuhn_mesh({5, 0.1});
  const auto at = place_points(view(source), target.points);
  const Values values = sampled(source.points, f), got = second_order(source, at, values);
  Values by_rows(at.size());
  apply(second_order_rows(view(source), at, gradient_rows(view(source))), values, 1, by_rows);
  for (std::size_t i = 0; i < got.size(); ++i) {
    CHECK(std::abs(got[i] - f(target.points[i])) < 1e-12);
    CHECK(std::abs(got[i] - by_rows[i]) < 1e-13);
  }
}

TEST_CASE("a mesh onto itself keeps every bit, limited or not", "[m2m][reconstruct]") {
  const TetMesh mesh = kuhn_mesh({4, 0.2});
  const auto at = place_points(view(mesh), mesh.points);
  const Values values = sampled(mesh.points, smooth);
  for (const Limit limit : {Limit::none, Limit::tetrahedron, Limit::patch})
    CHECK(second_order(mesh, at, values, limit) == values);
}

TEST_CASE("limited values lie within those of the tetrahedron or of its patch",
          "[m2m][reconstruct]") {
  const TetMesh source = kuhn_mesh({8, 0.2}), target = kuhn_mesh({13, 0.2});
  const auto at = place_points(view(source), target.points);
  const Values values = sampled(source.points, ball), free = second_order(source, at, values);
  CHECK(*std::min_element(free.begin(), free.end()) < -0.05);
  CHECK(*std::max_element(free.begin(), free.end()) > 1.05);
  const Values near = second_order(source, at, values, Limit::tetrahedron);
  const Values patch = second_order(source, at, values, Limit::patch);
  std::vector<std::set<double>> around(source.n_points());  // values at a vertex and its neighbours
  for (const Tet& tet : source.tets)
    for (const VertexId v : tet)
      for (const VertexId w : tet)
        around[static_cast<std::size_t>(v)].insert(values[static_cast<std::size_t>(w)]);
  std::size_t n_wider = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    double low = 1, high = 0, patch_low = 1, patch_high = 0;
    for (const VertexId vertex : source.tets[static_cast<std::size_t>(at[i].tet)]) {
      const auto v = static_cast<std::size_t>(vertex);
      low = std::min(low, values[v]);
      high = std::max(high, values[v]);
      patch_low = std::min(patch_low, *around[v].begin());
      patch_high = std::max(patch_high, *around[v].rbegin());
    }
    CHECK(near[i] == std::clamp(free[i], low, high));
    CHECK(patch[i] == std::clamp(free[i], patch_low, patch_high));
    n_wider += patch[i] != near[i] ? 1U : 0U;
  }
  CHECK(n_wider > 10);
}

TEST_CASE("the limit by patches keeps the order on a smooth field without extrema",
          "[m2m][reconstruct]") {
  const auto f = [](const Point& p) { return std::exp(p[0] + 0.5 * p[1] - 0.7 * p[2]); };
  Values errors;
  for (const std::int32_t n : {8, 16}) {
    const TetMesh source = kuhn_mesh({n, 0.15}), target = kuhn_mesh({n + 3, 0.1});
    const auto at = place_points(view(source), target.points);
    errors.push_back(rms(second_order(source, at, sampled(source.points, f), Limit::patch),
                         sampled(target.points, f)));
  }
  CHECK(order_of(errors) > 2.7);
}

TEST_CASE("fields in tetrahedra: constant is first order, linear by gradients second order",
          "[m2m][reconstruct]") {
  Values constant, linear;
  for (const std::int32_t n : {6, 12, 24}) {
    const TetMesh source = kuhn_mesh({n, 0.15}), target = kuhn_mesh({n + 3, 0.1});
    const auto at = place_points(view(source), centroids(view(target)));
    const Values want = sampled(centroids(view(target)), smooth);
    const Values values = sampled(centroids(view(source)), smooth);
    const Rows<Point> rows = cell_gradient_rows(view(source));
    std::vector<Point> gradients(rows.n_rows());
    apply(rows, values, 1, gradients);
    Values got(at.size());
    cell_values(view(source), at, values, {}, 1, got);
    constant.push_back(rms(got, want));
    cell_values(view(source), at, values, gradients, 1, got);
    linear.push_back(rms(got, want));
    Values by_rows(at.size());
    apply(cell_rows(view(source), at, rows), values, 1, by_rows);
    CHECK(rms(by_rows, got) < 1e-14);
  }
  CAPTURE(constant, linear);
  CHECK(std::abs(order_of(constant) - 1) < 0.1);
  CHECK(order_of(linear) > 1.85);
}

TEST_CASE("limited gradients of tetrahedra create no new extremum and keep the integral",
          "[m2m][reconstruct]") {
  const TetMesh source = kuhn_mesh({7, 0.2}), target = kuhn_mesh({6, 0.2});
  const Values values = sampled(centroids(view(source)), ball);
  const Rows<Point> rows = cell_gradient_rows(view(source));
  std::vector<Point> gradients(rows.n_rows());
  apply(rows, values, 1, gradients);
  const Values free = corner_values(view(source), values, gradients, 1);
  CHECK(*std::min_element(free.begin(), free.end()) < -0.05);
  limit_cell_gradients(view(source), values, 1, gradients);
  const Values corners = corner_values(view(source), values, gradients, 1);
  for (const double value : corners) CHECK((value >= -1e-15 && value <= 1 + 1e-15));
  // Conservative means of the target's tetrahedra from the limited linear field.
  const OverlapRows overlaps =
      tess::test::rows_between(source, Centring::corners, target, Centring::cells);
  Values loads(target.n_tets());
  apply(overlaps.rows, corners, 1, loads);
  double want = 0, got = 0;
  for (std::size_t t = 0; t < source.n_tets(); ++t) want += values[t] * signed_volume(source, t);
  for (std::size_t t = 0; t < target.n_tets(); ++t) {
    const double mean = loads[t] / signed_volume(target, t);
    got += loads[t];
    CHECK((mean >= -1e-13 && mean <= 1 + 1e-13));
  }
  CHECK(std::abs(got - want) < 1e-13 * want);
}

TEST_CASE("values follow the place of the mesh", "[m2m][reconstruct]") {
  TetMesh source = kuhn_mesh({4, 0.2}), target = kuhn_mesh({5, 0.2});
  // Coordinates of 20 bits, which an offset of 1e9 leaves exact.
  for (TetMesh* mesh : {&source, &target})
    for (Point& p : mesh->points)
      for (double& x : p) x = std::round(x * 0x1p20) * 0x1p-20;
  const Values values = sampled(source.points, smooth);
  const Values want = second_order(source, place_points(view(source), target.points), values);
  for (TetMesh* mesh : {&source, &target})
    for (Point& p : mesh->points) p = {p[0] + 1e9, p[1] - 1e9, p[2] + 1e9};
  CHECK(second_order(source, place_points(view(source), target.points), values) == want);
}
