// Conservative transfers between walls: what they keep, their orders, and which triangles overlap.
#include "m2m/cell_transfer.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/rows/supermesh/triangles.hpp"
#include "tests/m2m/wall_transfers.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/run.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

using namespace tess;
using namespace tess::m2m;
using tess::test::result_of;
using tess::test::Wall, tess::test::wall_mesh, tess::test::WallCase, tess::test::WallResult;

namespace {

constexpr std::array conserving{TransferKind::conservative, TransferKind::conservative_bounded,
                                TransferKind::conservative_lumped};

double skew(const Point& p) {
  return 3 + 2 * p[0] - 3 * p[1] + p[2];
}
double unity(const Point& /*p*/) {
  return 1;
}

/// Integrates values at the points of a wall.
double wall_integral(const TetMesh& wall, const std::vector<double>& values) {
  long double sum = 0;
  for (const Tet& cell : wall.tets) {
    const double area = measure(corners_of(wall.points, cell), 2);
    for (std::size_t a = 0; a < 3; ++a) sum += area / 3 * values[static_cast<std::size_t>(cell[a])];
  }
  return static_cast<double>(sum);
}
double source_integral(const WallCase& c) {
  std::vector<double> values;
  for (const Point& p : c.from.points) values.push_back(c.field(p));
  return wall_integral(c.from, values);
}
TetMesh scaled(TetMesh wall, double factor, double lift = 0) {
  for (Point& p : wall.points) p = {factor * p[0], factor * p[1], factor * p[2] + lift};
  return wall;
}
/// Two plane sheets at the distance `thickness`, whose normals point outward.
TetMesh plate(int n, double thickness) {
  TetMesh both = wall_mesh(Wall::plane, n), top = scaled(both, 1, thickness);
  const auto n_points = static_cast<VertexId>(both.n_points());
  both.points.insert(both.points.end(), top.points.begin(), top.points.end());
  for (std::size_t t = 0; t < top.n_tets(); ++t) {
    const auto [a, b, c, d] = top.tets[t];
    both.tets.push_back({a + n_points, b + n_points, c + n_points, c + n_points});
    both.tets[t] = {b, a, c, c};
  }
  return both;
}

struct WallError {
  double values = 0, integral = 0;
};
WallError error_on(Wall wall, int n, TransferKind kind) {
  const WallCase c{
      wall_mesh(wall, n), wall_mesh(wall, n * 5 / 4, 0.3), {.kind = kind, .tolerance = 0.3}, 2};
  const WallResult result = result_of(c);
  WallError error;
  for (std::size_t v = 0; v < c.to.n_points(); ++v)
    error.values += std::pow(result.outcome.values[v] - c.field(c.to.points[v]), 2) /
                    static_cast<double>(c.to.n_points());
  error.values = std::sqrt(error.values);
  error.integral = std::abs(wall_integral(c.to, result.outcome.values) / source_integral(c) - 1);
  return error;
}

std::string complaint(const TetMesh& from, const TetMesh& to, TransferOptions options) {
  WallResult result;
  const WallCase c{from, to, options};
  return tests::error_of("pes=2,cost=100ns", [&] { return test::run_case(c, result); });
}

Task move_cells(const TetMesh& from, const TetMesh& to, TransferKind kind, CellOutcome& out) {
  std::vector<Field> fields(1, Field{"f", 1, {}});
  for (const Tet& cell : from.tets) {
    const auto c = corners_of(from.points, cell);
    fields[0].values.push_back(skew(mean_of_corners(c, 2)));
  }
  out = co_await transfer_cells(from, fields, to, 3, PartitionMethod::curve, {.kind = kind});
}

}  // namespace

TEST_CASE("plane meshes keep integrals and linear fields", "[m2m][walls][conservative]") {
  for (const TransferKind kind : conserving) {
    INFO(name_of(kind));
    const WallCase c{
        wall_mesh(Wall::plane, 7), wall_mesh(Wall::plane, 9), {.kind = kind}, 3, &skew};
    const WallResult result = result_of(c);
    CHECK(result.tally.count(Status::inside) == c.to.n_points());
    CHECK(result.tally.n_overcovered == 0);
    CHECK(std::abs(wall_integral(c.to, result.outcome.values) / source_integral(c) - 1) < 1e-13);
    double worst = 0;
    for (std::size_t v = 0; v < c.to.n_points(); ++v)
      worst = std::max(worst, std::abs(result.outcome.values[v] - skew(c.to.points[v])));
    CHECK((worst < 1e-12) == (kind != TransferKind::conservative_lumped));
    CHECK(worst < 0.5);
  }
}

TEST_CASE("what a wall covers in part keeps its integral", "[m2m][walls][conservative]") {
  // The source covers a fourth of the target, up to edges that both have.
  const TetMesh from = wall_mesh(Wall::plane, 7), to = scaled(wall_mesh(Wall::plane, 6), 2);
  CellOutcome cells;
  CHECK(tests::run("pes=2,cost=100ns", [&] {
          return move_cells(from, to, TransferKind::conservative, cells);
        }).report.empty());
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t t = 0; t < to.n_tets(); ++t) {
    if (cells.status[t] == Status::outside) continue;
    ++n;
    const auto c = corners_of(to.points, to.tets[t]);
    sum += measure(c, 2) * cells.fields[0].values[t];
    CHECK(cells.fields[0].values[t] == Approx(skew(mean_of_corners(c, 2))).epsilon(1e-12));
  }
  CHECK(n == 18);
  CHECK(sum == Approx(source_integral({from, to, {}, 1, &skew})).epsilon(1e-13));
  const WallCase c{from, to, {.policy = UseValue{9}, .kind = TransferKind::conservative}, 3, &skew};
  const WallResult result = result_of(c);
  CHECK(result.tally.count(Status::inside) == 9);
  CHECK(result.tally.count(Status::snapped) == 7);
  CHECK(result.tally.n_overcovered == 0);
  for (std::size_t v = 0; v < to.n_points(); ++v) {
    const double right = result.outcome.status[v] == Status::outside ? 9 : skew(to.points[v]);
    if (!(std::abs(result.outcome.values[v] - right) < 1e-12)) FAIL("point " << v);
  }
}

TEST_CASE("curved walls keep constants, and what they cover is known exactly",
          "[m2m][walls][conservative]") {
  for (const Wall wall : {Wall::sphere, Wall::torus})
    for (const TransferKind kind : conserving) {
      const WallCase c{
          wall_mesh(wall, 7), wall_mesh(wall, 5, 0.3), {.kind = kind, .tolerance = 0.3}, 2, &unity};
      const WallResult result = result_of(c);
      CHECK(result.tally.count(Status::inside) == c.to.n_points());
      CHECK(result.tally.n_overcovered == 0);
      for (const double value : result.outcome.values)
        if (!(std::abs(value - 1) < 1e-13)) FAIL("value " << value);
    }
}

TEST_CASE("on curved walls values and integrals are of the order 2",
          "[m2m][walls][conservative][one_thread]") {
  for (const Wall wall : {Wall::sphere, Wall::torus})
    for (const TransferKind kind : conserving) {
      const WallError coarse = error_on(wall, 8, kind), fine = error_on(wall, 16, kind);
      const double values = std::log2(coarse.values / fine.values);
      const double integral = std::log2(coarse.integral / fine.integral);
      CAPTURE(static_cast<int>(wall), name_of(kind), values, integral, coarse.integral,
              fine.integral);
      CHECK((values > (kind == TransferKind::conservative_lumped ? 1.2 : 1.7) && values < 2.6));
      CHECK((integral > 1.7 && integral < 2.6));
      CHECK(fine.integral < 0.01);
    }
}

TEST_CASE("a conservative transfer of a wall gives the same bits for any pieces and schedule",
          "[m2m][walls][conservative]") {
  const TetMesh from = wall_mesh(Wall::torus, 5), to = wall_mesh(Wall::torus, 7, 0.2);
  for (const TransferKind kind : conserving) {
    const WallCase c{from, to, {.kind = kind, .tolerance = 0.01}, 1};  // farther gaps are left out
    const WallResult alone = result_of(c);
    CHECK(alone.tally.count(Status::snapped) > 0);
    test::for_seeds(2, 2 + test::n_seeds(6), [&](std::uint64_t seed) {
      WallCase cut = c;
      cut.n_parts = static_cast<std::int32_t>(1 + seed * 5 % 12);
      test::check_same(result_of(cut, seed), alone);
    });
  }
}

TEST_CASE("both sides of a thin plate are apart, or counted", "[m2m][walls][conservative]") {
  const auto height = [](const Point& p) { return p[2] - 0.3 * p[0] - 0.2 * p[1]; };
  WallCase c{plate(4, 0.05), plate(5, 0.05), {.kind = TransferKind::conservative}, 2, height};
  for (Tet& cell : c.to.tets) std::swap(cell[0], cell[1]);  // as the wall of what is around
  for (const auto& [tolerance, facing] : {std::pair{0.0, Facing::either},
                                          {0.04, Facing::either},
                                          {0.06, Facing::either},
                                          {0.06, Facing::opposite}}) {
    c.options.tolerance = tolerance;
    c.options.facing = facing;
    const WallResult result = result_of(c);
    const bool apart = tolerance < 0.045 || facing == Facing::opposite;  // along the normal
    CAPTURE(tolerance, result.tally.most_covered);
    CHECK(result.tally.n_overcovered == (apart ? 0 : c.to.n_points()));
    for (std::size_t v = 0; v < c.to.n_points(); ++v)
      // The sheets do not lie above each other exactly, seen along the normal.
      CHECK(std::abs(result.outcome.values[v] - (apart ? height(c.to.points[v]) : 0.025)) <
            (apart ? 1e-13 : 0.01));
  }
  c.options.facing = Facing::same;
  CHECK(result_of(c).tally.count(Status::outside) == 0);  // each side takes from the other
  c.options.tolerance = 0;
  CHECK(result_of(c).tally.count(Status::outside) == c.to.n_points());
}

TEST_CASE("triangles overlap if they are turned by at most 60 degrees",
          "[m2m][walls][conservative]") {
  const TrianglePlane flat({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}});
  for (const double degrees : {0.0, 59.0, 61.0, 89.0}) {
    const double c = std::cos(degrees * std::numbers::pi / 180),
                 s = std::sin(degrees * std::numbers::pi / 180);
    const TrianglePlane turned({{{0, 0, 0}, {1, 0, 0}, {0, c, s}, {0, c, s}}});
    TriangleCutter cutter(2);
    cutter.add(turned, flat, 1);
    INFO(degrees << " degrees");
    CHECK(cutter.size() == (degrees < 60 ? 1 : 0));
  }
}

TEST_CASE("moments of triangles are those of cones over them", "[m2m][walls][conservative]") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t n_apart = 0;
  for (int k = 0; k < 2000; ++k) {
    std::array<Corners, 2> flat, cones;
    for (std::size_t side = 0; side < 2; ++side) {
      const double size = k % 3 == 0 && side == 1 ? 0.01 : 1;
      for (std::size_t a = 0; a < 3; ++a)
        flat[side][a] = {0.4 + size * unit(random), 0.4 + size * unit(random), 0};
      flat[side][3] = flat[side][2];
      cones[side] = flat[side];
      cones[side][3] = {0.3, 0.6, 1};
    }
    TriangleCutter cutter(0);
    const TrianglePlane from(flat[0]), to(flat[1]);
    cutter.add(from, to, 7);
    PairMoments found;
    cutter.cut([&](std::int32_t number, const PairMoments& moments) {
      CHECK(number == 7);
      found = moments;
    });
    CHECK(cutter.size() == 0);
    const PairMoments oracle = pair_moments(cones[0], cones[1]);
    const double near = 1e-12 * to.area;
    if (found.volume == 0) ++n_apart;
    if (!(std::abs(found.volume - 3 * oracle.volume) < near)) FAIL("area of pair " << k);
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        if (!(std::abs(found.mixed[a][b] - 5 * oracle.mixed[a][b]) < near))
          FAIL("moment of pair " << k);
    CHECK(found.mixed[3] == std::array<double, 4>{});
  }
  CHECK((n_apart > 200 && n_apart < 1800));
}

TEST_CASE("conservative kinds refuse other pairs of meshes", "[m2m][walls][conservative]") {
  using Catch::Matchers::Contains;
  const TetMesh wall = wall_mesh(Wall::plane, 2), box = kuhn_mesh({1}), line = test::circle_mesh(4);
  CHECK_THAT(
      complaint(box, wall, {.kind = TransferKind::conservative}),
      Contains(
          "needs two meshes of the same cells; the source has tetrahedra, the target triangles"));
  CHECK_THAT(complaint(wall, line, {.kind = TransferKind::conservative_lumped}),
             Contains("needs tetrahedra or triangles; the mesh has edges"));
  CHECK_THAT(complaint(box, box, {.kind = TransferKind::conservative, .tolerance = 0.1}),
             Contains("takes a tolerance between triangles only"));
}
