#include "m2m/rows/weights/native_rows.hpp"

#include "m2m/kuhn.hpp"
#include "tests/m2m/element_meshes.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <functional>
#include <vector>

using namespace tess::m2m;
using tess::test::element_mesh, tess::test::native_values, tess::test::place_points,
    tess::test::sampled, tess::test::shaken, tess::test::smooth, tess::test::Values;

namespace {

/// The places in a cube of equal bricks, of which element_mesh() makes bricks that grow.
Point equal(const Point& p) {
  Point q;
  for (std::size_t k = 0; k < 3; ++k) q[k] = (1.15 - std::sqrt(1.15 * 1.15 - 0.6 * p[k])) / 0.3;
  return q;
}
Point sheared(const Point& q) {
  return {2 * q[0] + q[1] + 3, q[1] - 0.3 * q[2], 0.5 * q[2] + 0.2 * q[0]};
}
std::vector<Point> mapped(std::vector<Point> points, Point (*map)(const Point&)) {
  for (Point& p : points) p = map(p);
  return points;
}

/// Norms over all targets.
struct Errors {
  double native = 0, linear = 0;
  std::uint64_t n_linear = 0;
};
Errors errors_at(const TetMesh& mesh, const Values& values, const std::vector<Point>& targets,
                 const Values& want) {
  Errors out;
  const Values native = native_values(mesh, values, targets, out.n_linear);
  const auto places = place_points(tess::test::view(mesh), targets);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Tet& tet = mesh.tets[static_cast<std::size_t>(places[i].tet)];
    const double linear = interpolated(places[i].weights, tet, values.data(), 1);
    out.native = std::hypot(out.native, native[i] - want[i]);
    out.linear = std::hypot(out.linear, linear - want[i]);
  }
  return out;
}

}  // namespace

TEST_CASE("the fields of the shape functions are exact in sheared elements", "[m2m][native]") {
  struct Exact {
    ElementType type;
    double (*field)(const Point&);
  };
  constexpr std::array cases{
      Exact{ElementType::hex8,
            [](const Point& q) { return 1 + q[0] * q[1] * q[2] - 2 * q[0] * q[1] + q[1] * q[2]; }},
      Exact{ElementType::wedge6,
            [](const Point& q) { return q[0] * q[2] + (2 * q[1] - 3) * q[2]; }},
      Exact{ElementType::tet10,
            [](const Point& q) { return q[0] * q[1] - 2 * q[2] * q[2] + q[1] * q[1]; }},
      Exact{ElementType::hex27,
            [](const Point& q) { return q[0] * q[0] * q[1] * (1 - q[1]) * q[2] - q[2] * q[2]; }}};
  for (const auto& [type, field] : cases) {
    CAPTURE(name_of(type));
    TetMesh mesh = element_mesh(type, 3);
    mesh.points = mapped(mesh.points, equal);
    const std::vector<Point> at = kuhn_mesh({5, 0.2}).points;
    const Values values = sampled(mesh.points, field);
    mesh.points = mapped(mesh.points, sheared);
    const Errors errors = errors_at(mesh, values, mapped(at, sheared), sampled(at, field));
    CHECK(errors.native < 1e-13);
    CHECK(errors.linear > 1e-2);
    CHECK(errors.n_linear == 0);
  }
}

TEST_CASE("in distorted elements linear fields are exact, and a vertex keeps its value",
          "[m2m][native]") {
  for (const ElementType type : tess::test::native_element_types) {
    CAPTURE(name_of(type));
    const TetMesh mesh = shaken(element_mesh(type, 4), type >= ElementType::tet10 ? 0.01 : 0.04);
    const std::vector<Point> at = kuhn_mesh({5, 0.2}).points;
    const Values values = sampled(mesh.points, tess::test::linear_at);
    const Errors errors = errors_at(mesh, values, at, sampled(at, tess::test::linear_at));
    CHECK(errors.native < 1e-13);
    CHECK(errors.n_linear == 0);
    std::uint64_t n_linear = 0;
    const Values rough = sampled(mesh.points, smooth);
    CHECK(native_values(mesh, rough, mesh.points, n_linear) == rough);
  }
}

TEST_CASE("smooth fields have the order of the elements, also distorted ones", "[m2m][native]") {
  struct Want {
    ElementType type;
    double order, beside_linear;
  };
  for (const Want& want :
       {Want{ElementType::hex8, 1.8, 0.95}, Want{ElementType::wedge6, 1.8, 1.1},
        Want{ElementType::pyramid5, 1.8, 0.98}, Want{ElementType::tet10, 2.6, 0.1},
        Want{ElementType::hex27, 2.6, 0.1}}) {
    std::vector<Errors> errors;
    const std::vector<Point> at = kuhn_mesh({13, 0.2}).points;
    for (const int n : {4, 8}) {
      const double amount = (want.type >= ElementType::tet10 ? 0.1 / n : 0.6) / (4 * n);
      const TetMesh mesh = shaken(element_mesh(want.type, n), amount);
      errors.push_back(errors_at(mesh, sampled(mesh.points, smooth), at, sampled(at, smooth)));
      CHECK(errors.back().n_linear == 0);
    }
    const double order = std::log2(errors[0].native / errors[1].native);
    CAPTURE(name_of(want.type), errors[0].native, errors[1].native, errors[1].linear);
    CHECK(order > want.order);
    CHECK(errors[1].native < want.beside_linear * errors[1].linear);
  }
}

TEST_CASE("in an element that folds over, values are linear and counted", "[m2m][native]") {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  ElementSplitter splitter(mesh);
  splitter.add(ElementType::hex8, std::array{0, 1, 3, 2, 4, 5, 7, 6});  // not the order of ExodusII
  splitter.finish();
  const std::vector<Point> at{{0.5, 0.1, 0.3}, {0.4, 0.45, 0.7}, {0.2, 0.15, 0.5}};
  const Values values = sampled(mesh.points, smooth);
  std::uint64_t n_linear = 0;
  const Values got = native_values(mesh, values, at, n_linear);
  const auto places = place_points(tess::test::view(mesh), at);
  std::uint64_t n_equal = 0;
  for (std::size_t i = 0; i < at.size(); ++i)
    n_equal += got[i] == interpolated(places[i].weights,
                                      mesh.tets[static_cast<std::size_t>(places[i].tet)],
                                      values.data(), 1);
  CHECK(n_linear > 0);
  CHECK(n_equal == n_linear);
}

TEST_CASE("damaged elements are refused", "[m2m][native]") {
  const TetMesh mesh = element_mesh(ElementType::hex8, 2);
  (void)validate(mesh);
  const auto refused = [](TetMesh damaged, const char* message) {
    CHECK_THROWS_WITH(validate(damaged), Contains(message));
  };
  TetMesh damaged = mesh;
  damaged.elements.of_tet.pop_back();
  refused(damaged, "elements of 47 of 48 tetrahedra are given");
  damaged = mesh;
  damaged.elements.of_tet[7] += 1;
  refused(damaged, "the element of tetrahedron 7 begins at");
  damaged = mesh;
  std::swap(damaged.elements.of_tet[7], damaged.elements.of_tet[13]);
  refused(damaged, "which is no vertex of its element");
}
