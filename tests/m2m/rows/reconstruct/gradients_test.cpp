#include "m2m/rows/reconstruct/gradients.hpp"

#include "apps/kit/worst.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/rows/reconstruct/second_order.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <functional>

using namespace tess::m2m;
using tess::test::sampled, tess::test::view;

namespace {

std::vector<Point> gradients_of(const Rows<Point>& rows, const std::vector<double>& values) {
  std::vector<Point> gradients(rows.n_rows());
  apply(rows, values, 1, gradients);
  return gradients;
}

/// The largest error of a component over all vertices, as a part of the largest gradient.
double worst(const std::vector<Point>& got, std::span<const Point> at,
             const std::function<Point(const Point&)>& want) {
  double error = 0, largest = 0;
  for (std::size_t v = 0; v < got.size(); ++v) {
    const Point g = want(at[v]);
    for (std::size_t k = 0; k < 3; ++k) {
      kit::worsen(error, std::abs(got[v][k] - g[k]));
      largest = std::max(largest, std::abs(g[k]));
    }
  }
  return error / largest;
}

double quadratic(const Point& p) {
  return 1 + 2 * p[0] - p[1] + 3 * p[0] * p[0] - p[1] * p[2] + 0.5 * p[2] * p[2] - p[0] * p[1];
}
Point quadratic_gradient(const Point& p) {
  return {2 + 6 * p[0] - p[1], -1 - p[2] - p[0], -p[1] + p[2]};
}
Point stretched(Point p) {
  return {p[0] * p[0] * 0.5 + 0.5 * p[0], p[1] + 0.1 * std::sin(3 * p[0]),
          p[2] * 0.3 + 0.05 * p[1]};
}

}  // namespace

TEST_CASE("gradients of quadratic fields are exact, at corners and edges of the domain, too",
          "[m2m][reconstruct]") {
  for (const double jitter : {0.0, 0.2}) {
    const TetMesh mesh = kuhn_mesh({4, jitter});
    const auto got = gradients_of(gradient_rows(view(mesh)), sampled(mesh.points, quadratic));
    CHECK(worst(got, mesh.points, quadratic_gradient) < 1e-12);
  }
}

TEST_CASE("recovered gradients are second order, on distorted meshes and at boundaries, too",
          "[m2m][reconstruct]") {
  const auto f = [](const Point& p) {
    return std::sin(2 * p[0]) * std::cos(p[1]) * std::exp(p[2]);
  };
  const auto g = [](const Point& p) {
    return Point{2 * std::cos(2 * p[0]) * std::cos(p[1]) * std::exp(p[2]),
                 -std::sin(2 * p[0]) * std::sin(p[1]) * std::exp(p[2]),
                 std::sin(2 * p[0]) * std::cos(p[1]) * std::exp(p[2])};
  };
  for (const double jitter : {0.0, 0.2}) {
    std::vector<double> errors;
    for (const std::int32_t n : {5, 10, 20}) {
      TetMesh mesh = kuhn_mesh({n, jitter});
      for (Point& p : mesh.points) p = stretched(p);
      const auto got = gradients_of(gradient_rows(view(mesh)), sampled(mesh.points, f));
      errors.push_back(worst(got, mesh.points, g));
    }
    CAPTURE(jitter, errors);
    CHECK(std::log2(errors[1] / errors[2]) > 1.75);
  }
}

TEST_CASE("gradients follow scale, aspect and place of the mesh", "[m2m][reconstruct]") {
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  const Rows<Point> rows = gradient_rows(view(mesh));
  const auto values = sampled(mesh.points, quadratic);
  const auto want = gradients_of(rows, values);
  const auto check = [&](const Point& factor, const Point& shift, double tolerance) {
    TetMesh other = mesh;
    for (Point& p : other.points)
      for (std::size_t k = 0; k < 3; ++k) p[k] = factor[k] * p[k] + shift[k];
    const auto got = gradients_of(gradient_rows(view(other)), values);
    double error = 0;
    for (std::size_t v = 0; v < got.size(); ++v)
      for (std::size_t k = 0; k < 3; ++k)
        kit::worsen(error, std::abs(got[v][k] * factor[k] - want[v][k]));
    CAPTURE(factor, shift);
    CHECK(error < tolerance);
  };
  for (const double scale : {1e-90, 1e-30, 1e30, 1e90})
    check({scale, scale, scale}, {0, 0, 0}, 1e-11);
  check({1, 1, 1e-6}, {0, 0, 0}, 1e-8);
  check({1, 1e-3, 1e3}, {0, 0, 0}, 1e-8);
  check({1, 1, 1}, {1e6, -1e6, 1e6}, 1e-7);
  check({1, 1, 1e-12}, {0, 0, 0}, 1e-8);
}

TEST_CASE("vertices that nearly coincide do not spoil gradients", "[m2m][reconstruct]") {
  // A tetrahedron of each vertex is cut at a point very near to it.
  for (const double distance : {1e-8, 1e-12, 1e-15}) {
    TetMesh mesh = kuhn_mesh({3, 0.2});
    const std::size_t n = mesh.n_tets();
    for (std::size_t t = 0; t < n; t += 7) {
      const Tet tet = mesh.tets[t];
      Point near{};
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < 3; ++k)
          near[k] += (c == 0 ? 1 - 3 * distance : distance) *
                     mesh.points[static_cast<std::size_t>(tet[c])][k];
      const auto middle = static_cast<VertexId>(mesh.n_points());
      mesh.points.push_back(near);
      for (std::size_t c = 0; c < 4; ++c) {
        Tet part = tet;
        part[c] = middle;
        if (c == 0)
          mesh.tets[t] = part;
        else
          mesh.tets.push_back(part);
      }
    }
    const auto linear = [](const Point& p) { return 1 + p[0] + 2 * p[1] + 3 * p[2]; };
    const auto got = gradients_of(gradient_rows(view(mesh)), sampled(mesh.points, linear));
    CAPTURE(distance);
    CHECK(worst(got, mesh.points, [](const Point&) { return Point{1, 2, 3}; }) < 1e-10);
  }
}

TEST_CASE("patches that determine no full polynomial fall back", "[m2m][reconstruct]") {
  // One cube: eight vertices. The fit through seven neighbours is exact for linear fields.
  const TetMesh cube = kuhn_mesh({1});
  const auto linear = [](const Point& p) { return 4 - p[0] + 2 * p[1] + 7 * p[2]; };
  for (const Point& g : gradients_of(gradient_rows(view(cube)), sampled(cube.points, linear))) {
    CHECK(g[0] == Approx(-1).epsilon(1e-12));
    CHECK(g[1] == Approx(2).epsilon(1e-12));
    CHECK(g[2] == Approx(7).epsilon(1e-12));
  }
  // One layer of cubes: quadratic along the layer stays exact.
  TetMesh layer;
  layer.points = kuhn_mesh({5}).points;
  for (const Tet& tet : kuhn_mesh({5}).tets) {
    bool low = true;
    for (const VertexId v : tet) low = low && layer.points[static_cast<std::size_t>(v)][2] < 0.3;
    if (low) layer.tets.push_back(tet);
  }
  const auto parabola = [](const Point& p) { return p[0] * p[0] - p[0] * p[1] + 3 * p[2]; };
  const auto got = gradients_of(gradient_rows(view(layer)), sampled(layer.points, parabola));
  for (std::size_t v = 0; v < got.size(); ++v) {
    const Point& p = layer.points[v];
    if (p[2] > 0.3) {
      CHECK(got[v] == Point{0, 0, 0});  // no tetrahedron uses it
      continue;
    }
    CHECK(std::abs(got[v][0] - (2 * p[0] - p[1])) < 1e-12);
    CHECK(std::abs(got[v][1] + p[0]) < 1e-12);
    CHECK(std::abs(got[v][2] - 3) < 0.2);  // z and z² differ by a factor only
  }
  // All points in a plane, on a line, at one place: no gradient across.
  TetMesh flat{{}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2, 3}}};
  for (const Point& g : gradients_of(gradient_rows(view(flat)), sampled(flat.points, linear))) {
    CHECK(std::abs(g[0] + 1) < 1e-12);
    CHECK(std::abs(g[1] - 2) < 1e-12);
    CHECK(g[2] == 0);
  }
  TetMesh line{{}, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}, {{0, 1, 2, 3}}};
  for (const Point& g : gradients_of(gradient_rows(view(line)), sampled(line.points, linear)))
    CHECK(g[0] + g[1] + g[2] == Approx(8).epsilon(1e-12));
  TetMesh point{{}, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2, 3}}};
  for (const Point& g : gradients_of(gradient_rows(view(point)), {1, 2, 3, 4}))
    CHECK(g == Point{0, 0, 0});
}

TEST_CASE("gradients in tetrahedra are exact for linear fields", "[m2m][reconstruct]") {
  const TetMesh mesh = kuhn_mesh({3, 0.2});
  const auto linear = [](const Point& p) { return 4 - p[0] + 2 * p[1] + 7 * p[2]; };
  const std::vector<Point> centres = centroids(view(mesh));
  const auto got = gradients_of(cell_gradient_rows(view(mesh)), sampled(centres, linear));
  CHECK(worst(got, centres, [](const Point&) { return Point{-1, 2, 7}; }) < 1e-12);
}

TEST_CASE("rows of a part with two layers around are those of the whole mesh, bit for bit",
          "[m2m][reconstruct]") {
  const TetMesh mesh = kuhn_mesh({6, 0.2});
  const auto values =
      sampled(mesh.points, [](const Point& p) { return std::sin(9 * p[0] * p[1]); });
  const auto want = gradients_of(gradient_rows(view(mesh)), values);
  // The part: all tetrahedra within x < 0.7, with points in the opposite order.
  MeshView whole = view(mesh);
  std::vector<VertexId> local(mesh.n_points(), -1);
  std::vector<GlobalId> ids;
  TetMesh part;
  for (std::size_t v = mesh.n_points(); v-- > 0;) {
    if (whole.points[v][0] > 0.7) continue;
    local[v] = static_cast<VertexId>(ids.size());
    ids.push_back(static_cast<GlobalId>(v));
    part.points.push_back(whole.points[v]);
  }
  for (Tet tet : mesh.tets) {
    for (VertexId& v : tet) v = local[static_cast<std::size_t>(v)];
    if (*std::min_element(tet.begin(), tet.end()) >= 0) part.tets.push_back(tet);
  }
  std::vector<VertexId> inner;
  std::vector<double> my_values;
  for (std::size_t v = 0; v < ids.size(); ++v) {
    my_values.push_back(values[static_cast<std::size_t>(ids[v])]);
    if (part.points[v][0] < 0.3) inner.push_back(static_cast<VertexId>(v));
  }
  const auto got = gradients_of(gradient_rows(view(part), ids, inner), my_values);
  REQUIRE(got.size() > 90);
  for (std::size_t k = 0; k < got.size(); ++k)
    CHECK(got[k] == want[static_cast<std::size_t>(ids[static_cast<std::size_t>(inner[k])])]);
}
