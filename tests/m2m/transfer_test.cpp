#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/rows/interpolate/locate.hpp"
#include "tests/m2m/error_norms.hpp"
#include "tests/m2m/non_conforming.hpp"
#include "tests/m2m/samples.hpp"
#include "tests/m2m/serial_transfer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_data.hpp"

#include <algorithm>
#include <cmath>

using namespace tess::m2m;
using tess::test::error_norms, tess::test::made_mesh, tess::test::moved_by,
    tess::test::SerialReport, tess::test::shared_data, tess::test::transfer_serial;

namespace {

struct Moved {
  SerialReport report;
  std::vector<double> values;
  ErrorNorms norms;
};

/// Samples the formula on the source, transfers it, and compares it with the formula on the target.
Moved move_formula(const TetMesh& source, const TetMesh& target, const std::string& formula,
                   const OutsidePolicy& policy = UseValue{-7}) {
  const Formula truth = make_formula(formula, bounds(source));
  const std::vector<Field> from{sample(source, "f", truth)};
  std::vector<Field> to{{"f", 1, std::vector<double>(target.n_points(), 99)}};
  Moved moved{transfer_serial(source, from, target, to, policy), {}, {}};
  moved.values = to[0].values;
  moved.norms = error_norms(target, moved.values, sample(target, "f", truth).values);
  return moved;
}

std::uint64_t outside(const Moved& moved) {
  return moved.report.counts[static_cast<std::size_t>(Status::outside)];
}

/// Transfers each mesh onto itself.
void check_onto_itself(const std::vector<TetMesh>& meshes) {
  for (const TetMesh& mesh : meshes) {
    CAPTURE(mesh.name);
    const Moved moved = move_formula(mesh, mesh, "gaussian");
    CHECK(outside(moved) == 0);
    CHECK(moved.report.counts[static_cast<std::size_t>(Status::boundary)] == mesh.n_points());
    CHECK(moved.values == sample(mesh, "f", make_formula("gaussian", bounds(mesh))).values);
  }
}

/// Transfers a linear field between two meshes of the same box, both ways.
void check_linear_both_ways(const TetMesh& coarse, const TetMesh& fine, double largest) {
  for (const auto& [source, target] : {std::pair(&coarse, &fine), std::pair(&fine, &coarse)}) {
    const Moved moved = move_formula(*source, *target, "linear");
    CHECK(outside(moved) == 0);
    CHECK(moved.norms.linf < 1e-12 * largest);
  }
}

}  // namespace

TEST_CASE("a transfer onto the same mesh finds all vertices and keeps the values bit for bit",
          "[m2m][transfer]") {
  check_onto_itself({kuhn_mesh({6}), kuhn_mesh({5, 0.2}), moved_by(kuhn_mesh({5, 0.2}), 1, 1e9),
                     moved_by(kuhn_mesh({6}), 1e-9, 0), moved_by(kuhn_mesh({6}), 1e9, 0)});
}

TEST_CASE("a transfer onto the same gmsh mesh finds all vertices and keeps the values bit for bit",
          "[m2m][transfer][.][meshes]") {
  check_onto_itself({read_mesh(made_mesh("cube_0.113")), read_mesh(made_mesh("shaft_coarse"))});
}

TEST_CASE("a transfer onto the same real mesh finds all vertices and keeps the values bit for bit",
          "[m2m][transfer][.][shared_data]") {
  check_onto_itself({read_mesh(shared_data("nalu/3d_tet4_taylor_green_0p4.exo")),
                     read_mesh(shared_data("nalu/3d_tet4_pipe.exo"))});
}

TEST_CASE("two gmsh cubes find all vertices of each other, and a linear field is exact",
          "[m2m][transfer][.][meshes]") {
  check_linear_both_ways(read_mesh(made_mesh("cube_0.16")), read_mesh(made_mesh("cube_0.113")), 8);
}

TEST_CASE(
    "the two Taylor-Green meshes find all vertices of each other, and a linear field is exact",
    "[m2m][transfer][.][shared_data]") {
  check_linear_both_ways(read_mesh(shared_data("nalu/3d_tet4_taylor_green_0p4.exo")),
                         read_mesh(shared_data("nalu/3d_tet4_taylor_green_0p2.exo")), 32);
}

TEST_CASE("an offset of 1e9 and scales of 1e-9 and 1e9 lose no vertex and no accuracy",
          "[m2m][transfer]") {
  const TetMesh source = kuhn_mesh({7, 0.2}), target = kuhn_mesh({9, 0.2});
  const Moved plain = move_formula(source, target, "linear");
  CHECK(outside(plain) == 0);
  CHECK(plain.norms.linf < 1e-12);
  for (const auto& [scale, offset] :
       {std::pair(1e-9, 0.0), std::pair(1e9, 0.0), std::pair(1.0, 1e9), std::pair(1e9, 1e9)}) {
    CAPTURE(scale, offset);
    const TetMesh far_source = moved_by(source, scale, offset);
    const TetMesh far_target = moved_by(target, scale, offset);
    CHECK(far_source.n_points() == source.n_points());
    const std::string x = "(x - " + std::to_string(offset) + ") / " +
                          (scale == 1  ? "1"
                           : scale < 1 ? "1e-9"
                                       : "1e9");
    const Moved moved = move_formula(far_source, far_target, "3 - 2*" + x);
    CHECK(outside(moved) == 0);
    CHECK(moved.norms.linf < 2e-12);
  }
}

TEST_CASE(
    "vertices on faces, edges and corners of the source get the same tetrahedron as by brute force",
    "[m2m][transfer]") {
  const TetMesh source = kuhn_mesh({4});
  TetMesh target =
      kuhn_mesh({8});  // half of its vertices lie on faces, edges and vertices of the source
  target.points.push_back({0.5, 0.5, 1 + 1e-13});
  target.points.push_back({0.5, 0.5, 1.001});
  const Moved moved = move_formula(source, target, "linear");
  const auto& counts = moved.report.counts;
  CHECK(counts[static_cast<std::size_t>(Status::snapped)] == 1);
  CHECK(counts[static_cast<std::size_t>(Status::outside)] == 1);
  for (std::size_t v = 0; v < target.n_points(); ++v) {
    GlobalId first = -1;
    double least = INFINITY;
    for (std::size_t t = 0; t < source.n_tets(); ++t) {
      const auto found = locate(target.points[v], corners_of(source.points, source.tets[t]));
      if (!found) continue;
      const double rank = found->place == Place::corner ? -1 : found->distance;
      if (rank >= least) continue;
      least = rank;
      first = static_cast<GlobalId>(t);
    }
    if (first != moved.report.tet[v])
      FAIL("vertex " << v << ": " << first << " and " << moved.report.tet[v]);
  }
}

TEST_CASE("the orientation of the source tetrahedra does not change the result",
          "[m2m][transfer]") {
  const TetMesh source = kuhn_mesh({5, 0.2});
  TetMesh inverted = source;
  for (Tet& tet : inverted.tets) std::swap(tet[0], tet[1]);
  const TetMesh target = kuhn_mesh({6, 0.1});
  const Moved one = move_formula(source, target, "sin");
  const Moved other = move_formula(inverted, target, "sin");
  CHECK(one.report.status == other.report.status);
  CHECK(one.report.tet == other.report.tet);
  for (std::size_t v = 0; v < target.n_points(); ++v)
    if (!(std::abs(one.values[v] - other.values[v]) < 1e-14)) FAIL("vertex " << v);
}

TEST_CASE("the sine field converges with order 2", "[m2m][transfer]") {
  const TetMesh target = kuhn_mesh({31, 0.2});
  std::vector<double> errors;
  for (const std::int32_t n : {8, 16, 32, 64})
    errors.push_back(move_formula(kuhn_mesh({n}), target, "sin").norms.l2);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    CAPTURE(i, errors);
    CHECK(std::log2(errors[i - 1] / errors[i]) == Approx(2).margin(0.1));
  }
}

TEST_CASE("the sine field converges with order 2 over four gmsh cubes",
          "[m2m][transfer][.][meshes]") {
  const TetMesh target = kuhn_mesh({23, 0.2});
  std::vector<double> h, errors;
  for (const char* name : {"cube_0.16", "cube_0.113", "cube_0.08", "cube_0.0566"}) {
    const TetMesh source = read_mesh(made_mesh(name));
    h.push_back(std::cbrt(1.0 / static_cast<double>(source.n_tets())));
    errors.push_back(move_formula(source, target, "sin").norms.l2);
  }
  CAPTURE(errors);
  CHECK(std::log(errors[0] / errors[3]) / std::log(h[0] / h[3]) == Approx(2).margin(0.1));
}

TEST_CASE("flat tetrahedra lose no vertex and keep a linear field exact", "[m2m][transfer]") {
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (const double height : {1e-4, 1e-7, 1e-10}) {
    for (const bool turned : {false, true}) {
      CAPTURE(height, turned);
      const auto flatten = [&](TetMesh mesh) {
        for (Point& p : mesh.points) {
          p[2] *= height;
          if (turned) p = {p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]};
        }
        return mesh;
      };
      const TetMesh source = flatten(kuhn_mesh({6, 0.2})), target = flatten(kuhn_mesh({7, 0.2}));
      const Moved moved = move_formula(source, target, "linear");
      CHECK(outside(moved) == 0);
      CHECK(moved.norms.linf < 1e-11);
    }
  }
}

TEST_CASE("doubled vertices, flat tetrahedra and unused vertices do not change the result",
          "[m2m][transfer]") {
  TetMesh source = kuhn_mesh({4, 0.2});
  const std::size_t n = source.n_points();
  for (std::size_t v = 0; v < n; ++v) source.points.push_back(source.points[v]);
  for (std::size_t t = 0; t < source.n_tets(); t += 2)
    for (VertexId& v : source.tets[t])
      v += static_cast<VertexId>(n);  // half of the mesh uses the doubles
  source.tets.push_back({0, 1, 2, 1});
  source.tets.push_back({0, 1, 2, 3});  // four collinear points
  source.tets.insert(source.tets.begin(), Tet{0, 1, static_cast<VertexId>(n),
                                              5});  // flat and first: it holds its corners
  source.points.push_back({0.3, 0.3, 0.3});
  validate(source);
  const TetMesh target = kuhn_mesh({5, 0.2});
  const Moved moved = move_formula(source, target, "linear");
  CHECK(outside(moved) == 0);
  CHECK(moved.norms.linf < 1e-12);
  CHECK(outside(move_formula(source, source, "linear")) == 0);
}

TEST_CASE("a transfer onto the same non-conforming mesh is exact", "[m2m][transfer]") {
  const TetMesh mesh = tess::test::non_conforming_mesh();
  std::vector<Field> from{{"f", 1, {}}};
  const auto scramble = [](double x) { return std::fmod(x * 7919.0, 1.0); };
  for (const Point& p : mesh.points)
    from[0].values.push_back(scramble(p[0]) + scramble(3 * p[1]) + scramble(5 * p[2]));
  std::vector<Field> to{{"f", 1, std::vector<double>(mesh.n_points())}};
  const SerialReport report = transfer_serial(mesh, from, mesh, to, Keep{});
  for (std::size_t v = 0; v < mesh.n_points(); ++v) {
    if (to[0].values[v] != from[0].values[v]) FAIL("vertex " << v << " has another value");
    if (report.status[v] != Status::boundary) FAIL("vertex " << v << " is no corner");
  }
}

TEST_CASE("vertices outside are counted, and get the value of the policy", "[m2m][transfer]") {
  const TetMesh source = kuhn_mesh({4}), target = moved_by(kuhn_mesh({4}), 1, 0.5);
  const Formula truth = make_formula("x + 10*y + 100*z", bounds(source));
  const Field values = sample(source, "f", truth);
  for (const char* text : {"keep", "value:0.25", "nearest"}) {
    const Moved moved = move_formula(source, target, "x + 10*y + 100*z", parse_policy(text));
    CHECK(outside(moved) == 125 - 27);
    for (std::size_t v = 0; v < target.n_points(); ++v) {
      Point clamped = target.points[v];
      for (double& x : clamped) x = std::min(x, 1.0);
      const bool out = clamped != target.points[v];
      CHECK((moved.report.status[v] == Status::outside) == out);
      const double wanted = !out             ? truth(clamped)
                            : text[0] == 'k' ? 99
                            : text[0] == 'v' ? 0.25
                                             : truth(clamped);
      CHECK(moved.values[v] == Approx(wanted));
    }
  }
  for (const char* text : {"", "value:", "value:x", "value:inf", "value:1 ", "drop"})
    CHECK_THROWS_WITH(parse_policy(text), Contains("choose keep, nearest or value:NUMBER"));
}

TEST_CASE("several fields of several components are transferred together", "[m2m][transfer]") {
  const TetMesh source = kuhn_mesh({3}), target = kuhn_mesh({5, 0.1});
  Field velocity{"velocity", 3, {}};
  for (const Point& p : source.points)
    velocity.values.insert(velocity.values.end(), {p[0], 2 * p[1], p[2] - p[0]});
  const std::vector<Field> from{velocity,
                                sample(source, "linear", make_formula("linear", bounds(source)))};
  std::vector<Field> to{{"velocity", 3, std::vector<double>(3 * target.n_points())},
                        {"linear", 1, std::vector<double>(target.n_points())}};
  (void)transfer_serial(source, from, target, to, Keep{});
  for (std::size_t v = 0; v < target.n_points(); ++v) {
    const Point& p = target.points[v];
    CHECK(to[0].values[3 * v + 2] == Approx(p[2] - p[0]).margin(1e-13));
    CHECK(to[1].values[v] == Approx(1 + 2 * p[0] - 3 * p[1] + 5 * p[2]).margin(1e-13));
  }
}
