#include "m2m/io/elements/tet10.hpp"

#include "apps/kit/worst.hpp"
#include "m2m/kuhn.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <map>
#include <random>

using namespace tess::m2m;
using tess::test::place_points, tess::test::sampled, tess::test::smooth, tess::test::Values,
    tess::test::view;

namespace {

/// A mesh of ten-node tetrahedra, split: kuhn:n with a vertex in the middle of each edge.
TetMesh quadratic_mesh(std::int32_t n) {
  const TetMesh coarse = kuhn_mesh({n});
  TetMesh mesh;
  mesh.points = coarse.points;
  std::map<std::array<VertexId, 2>, VertexId> middles;
  for (const Tet& tet : coarse.tets) {
    Tet10 nodes{tet[0], tet[1], tet[2], tet[3]};
    constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [a, b] = std::minmax(tet[edges[e][0]], tet[edges[e][1]]);
      const auto [at, is_new] = middles.try_emplace({a, b}, static_cast<VertexId>(mesh.n_points()));
      if (is_new) {
        const Point p = mesh.points[static_cast<std::size_t>(a)],
                    q = mesh.points[static_cast<std::size_t>(b)];
        mesh.points.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
      }
      nodes[4 + e] = at->second;
    }
    split_element(ElementType::tet10, nodes, mesh.tets);
  }
  return mesh;
}

/// Bends the cube within itself.
Point bent(const Point& p) {
  const double bump = p[0] * (1 - p[0]) * p[1] * (1 - p[1]) * p[2] * (1 - p[2]);
  return {p[0] + 2 * bump, p[1] - 1.5 * bump, p[2] + bump};
}

Point point_at(const Tet10Points& nodes, const Weights& at) {
  const Tet10Weights shape = tet10_shape(at);
  Point p{};
  for (std::size_t n = 0; n < 10; ++n)
    for (std::size_t k = 0; k < 3; ++k) p[k] += shape[n] * nodes[n][k];
  return p;
}

/// The determinant of the map; the central differences of a quadratic map are its derivatives.
double determinant(const Tet10Points& nodes, const Weights& at) {
  std::array<Point, 3> by{};
  for (std::size_t k = 0; k < 3; ++k) {
    Weights up = at, down = at;
    up[k + 1] += 0.5, up[0] -= 0.5;
    down[k + 1] -= 0.5, down[0] += 0.5;
    const Point above = point_at(nodes, up), below = point_at(nodes, down);
    for (std::size_t axis = 0; axis < 3; ++axis) by[k][axis] = above[axis] - below[axis];
  }
  return 6 * signed_volume({Point{}, by[0], by[1], by[2]});
}

double worst(const TetMesh& mesh, const std::vector<Point>& targets, std::size_t& n_linear,
             const std::function<double(const Point&)>& f) {
  const auto at = place_points(view(mesh), targets);
  const Rows<double> rows = tet10_rows(view(mesh), at, targets, n_linear);
  Values got(targets.size());
  apply(rows, sampled(mesh.points, f), 1, got);
  double error = 0;
  for (std::size_t i = 0; i < got.size(); ++i) kit::worsen(error, std::abs(got[i] - f(targets[i])));
  return error;
}

}  // namespace

TEST_CASE("shape functions are 1 at their node and 0 at the others", "[m2m][elements]") {
  const Tet10Weights corner = tet10_shape({0, 0, 1, 0}), middle = tet10_shape({0, 0.5, 0, 0.5});
  for (std::size_t n = 0; n < 10; ++n) {
    CHECK(corner[n] == (n == 2 ? 1 : 0));
    CHECK(middle[n] == (n == 8 ? 1 : 0));
  }
}

TEST_CASE("the inverse of curved maps is found from the straight coordinates", "[m2m][elements]") {
  const TetMesh mesh = quadratic_mesh(1);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double scale : {1e-80, 1.0, 1e80}) {
    for (int i = 0; i < 100; ++i) {
      const Tet10 element = tet10_of(std::span(mesh.tets).subspan(8).first<8>());
      Tet10Points nodes;
      for (std::size_t n = 0; n < 10; ++n) {
        nodes[n] = mesh.points[static_cast<std::size_t>(element[n])];
        for (double& x : nodes[n]) x = scale * (x + (n < 4 ? 0 : 0.06 * (uniform(random) - 0.5)));
      }
      Weights want{uniform(random), uniform(random), uniform(random), uniform(random)};
      const double sum = want[0] + want[1] + want[2] + want[3];
      for (double& w : want) w /= sum;
      const auto found = tet10_invert(point_at(nodes, want), nodes, {0.25, 0.25, 0.25, 0.25});
      REQUIRE(found);
      for (std::size_t k = 0; k < 4; ++k) CHECK(std::abs((*found)[k] - want[k]) < 1e-11);
    }
  }
}

TEST_CASE("where an element folds over, no inverse is taken from behind the fold",
          "[m2m][elements]") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr Weights start{0.25, 0.25, 0.25, 0.25};
  int n_found = 0, n_refused = 0;
  for (int i = 0; i < 1000; ++i) {
    Tet10Points nodes{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    constexpr std::size_t edges[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
    for (std::size_t e = 0; e < 6; ++e)
      for (std::size_t k = 0; k < 3; ++k)
        nodes[4 + e][k] =
            0.5 * (nodes[edges[e][0]][k] + nodes[edges[e][1]][k]) + uniform(random) - 0.5;
    Weights at{uniform(random), uniform(random), uniform(random), uniform(random)};
    const double sum = at[0] + at[1] + at[2] + at[3];
    for (double& w : at) w /= sum;
    const auto found = tet10_invert(point_at(nodes, at), nodes, start);
    ++(found ? n_found : n_refused);
    if (found) CHECK(determinant(nodes, *found) * determinant(nodes, start) > 0);
  }
  CHECK(n_found > 500);
  CHECK(n_refused > 100);
}

TEST_CASE("elements without volume have no inverse", "[m2m][elements]") {
  Tet10Points nodes{};
  CHECK_FALSE(tet10_invert({0, 0, 0}, nodes, {0.25, 0.25, 0.25, 0.25}));
  nodes[0] = {NAN, 0, 0};
  CHECK_FALSE(tet10_invert({0, 0, 0}, nodes, {0.25, 0.25, 0.25, 0.25}));
}

TEST_CASE("quadratic fields are exact in straight elements, and a node keeps its value",
          "[m2m][elements]") {
  const TetMesh mesh = quadratic_mesh(2);
  std::size_t n_linear = 1;
  const auto f = [](const Point& p) { return 1 + p[0] * p[1] - 2 * p[2] * p[2] + p[1]; };
  CHECK(worst(mesh, kuhn_mesh({5, 0.2}).points, n_linear, f) < 1e-14 * 8);
  CHECK(n_linear == 0);
  const auto at = place_points(view(mesh), mesh.points);
  Values got(at.size());
  const Values values = sampled(mesh.points, smooth);
  apply(tet10_rows(view(mesh), at, mesh.points, n_linear), values, 1, got);
  CHECK(got == values);
}

TEST_CASE("curved ten-node tetrahedra are third order", "[m2m][elements]") {
  Values errors;
  for (const std::int32_t n : {2, 4, 8}) {
    TetMesh mesh = quadratic_mesh(n);
    for (Point& p : mesh.points) p = bent(p);
    std::size_t n_linear = 0;
    errors.push_back(worst(mesh, kuhn_mesh({11, 0.2}).points, n_linear, smooth));
    CHECK(n_linear == 0);
  }
  CAPTURE(errors);
  CHECK(std::log2(errors[1] / errors[2]) > 2.7);
}
