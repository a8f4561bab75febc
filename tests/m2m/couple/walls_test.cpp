// Couplings whose source or target is a wall, a plane mesh or a line: orders, and the same bits for
// any number of pieces and any schedule.
#include "apps/kit/worst.hpp"
#include "m2m/cell_transfer.hpp"
#include "m2m/kuhn.hpp"
#include "m2m/mesh_piece.hpp"
#include "m2m/placement.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/surface.hpp"
#include "tests/m2m/wall_transfers.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/n_seeds.hpp"
#include "tests/support/run.hpp"
#include "tests/support/shared_data.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numeric>

using namespace tess;
using namespace tess::m2m;
using tess::test::Wall;
using tess::test::wall_mesh, tess::test::WallCase, tess::test::WallResult, tess::test::result_of;

namespace {

struct Errors {
  double largest = 0, squares = 0;
};
Errors errors_of(const WallCase& c) {
  const WallResult result = result_of(c);
  Errors errors;
  for (std::size_t v = 0; v < c.to.n_points(); ++v) {
    const double error = std::abs(result.outcome.values[v] - c.field(c.to.points[v]));
    kit::worsen(errors.largest, error);
    errors.squares += error * error / static_cast<double>(c.to.n_points());
  }
  return errors;
}
double order_of(Wall wall, const TransferOptions& options) {
  const auto error = [&](int n) {
    // A plane's target is finer, so that its points lie within the source.
    const TetMesh to = wall == Wall::plane ? wall_mesh(wall, n + 3) : wall_mesh(wall, n + 2, 0.3);
    return errors_of({wall_mesh(wall, n), to, options, 2}).squares;
  };
  return 0.5 * std::log2(error(8) / error(16));
}

/// Shows the side of its points.
struct Sided : Chare<Sided>, MeshPiece<Sided> {
  void loaded() {}
  void sum_sides(Callback<std::int64_t> target) {
    std::int64_t n = 0;
    for (const std::int8_t side : this->side(id)) n += side;
    contribute(sum, n, std::move(target));
  }
  void know(CouplingId coupling) { id = coupling; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, mesh, id);
  }
  CouplingId id{};
};

Task sides(double radius, std::int64_t& sum) {
  TetMesh target = wall_mesh(Wall::sphere, 3, 0.2);
  for (Point& p : target.points)
    for (double& x : p) x *= radius;
  ArrayProxy<Sided> from, to;
  co_await epoch([&] {
    from = create_pieces<Sided>(wall_mesh(Wall::sphere, 6), 3);
    to = create_pieces<Sided>(target, 1);
  });
  Coupling coupling(from, to, {.kind = TransferKind::projection});
  co_await coupling.search();
  co_await epoch([&] { to.broadcast<&Sided::know>(coupling.id()); });
  sum = co_await to.reduce<&Sided::sum_sides>();
}

Task cells_of_walls(const TetMesh& from, const TetMesh& to, TransferKind kind, CellOutcome& out) {
  std::vector<Field> fields(1, Field{"f", 1, {}});
  for (const Tet& cell : from.tets) {
    const auto c = corners_of(from.points, cell);
    fields[0].values.push_back(c[0][0] + c[1][0] + c[2][0]);
  }
  out = co_await transfer_cells(from, fields, to, 3, PartitionMethod::curve, {.kind = kind});
}

Task time_walls(double offset, TransferOptions options) {
  const TetMesh from = wall_mesh(Wall::torus, 92);
  TetMesh to = wall_mesh(Wall::torus, 91, 0.3);
  for (Point& p : to.points) p[2] += offset;
  DistributedMesh source, target;
  co_await epoch([&] {
    const std::vector<double> values(from.n_points(), 1.0), none(to.n_points());
    source = scatter(from, {{"f", 1, values}}, 1, PartitionMethod::curve);
    target = scatter(to, {{"f", 1, none}}, 1, PartitionMethod::curve);
  });
  Transfer transfer(source, target, options);
  for (int k = 0; k < 5; ++k) {
    const Time start = now();
    const SearchSummary found = co_await transfer.search();
    const Time middle = now();
    co_await transfer.apply();
    fmt::print(
        "{} triangles, {} points: search {:.1f} ms ({:.1f} + {:.1f}), application {:.2f} ms; {} "
        "pairs\n",
        from.n_tets(), to.n_points(), 1e3 * seconds(middle - start), 1e3 * found.broad,
        1e3 * found.narrow, 1e3 * seconds(now() - middle), found.tally.n_candidates);
  }
}

Task place_wall(const TetMesh& wall, PlacedMesh& placed) {
  placed = co_await place(&wall, {.n_parts = 3});
}

}  // namespace

TEST_CASE("the error of each kind on a wall falls with its order", "[m2m][walls][one_thread]") {
  for (const Wall wall : {Wall::plane, Wall::sphere, Wall::torus}) {
    INFO("wall " << static_cast<int>(wall));
    const double nearest = order_of(wall, {.kind = TransferKind::nearest});
    const double projection = order_of(wall, {.kind = TransferKind::projection});
    const double linear = order_of(wall, {.kind = TransferKind::linear, .tolerance = 0.1});
    const TransferKind fits = TransferKind::moving_least_squares;
    const double of_order_1 = order_of(wall, {.kind = fits, .order = 1}),
                 of_order_2 = order_of(wall, {.kind = fits, .order = 2});
    CAPTURE(nearest, projection, linear, of_order_1, of_order_2);
    CHECK((nearest > 0.6 && nearest < 1.4));
    CHECK((projection > 1.7 && projection < 2.4));
    CHECK(linear == projection);
    CHECK((of_order_1 > 1.7 && of_order_1 < 2.4));
    CHECK((of_order_2 > 2.7 && of_order_2 < 3.9));
  }
}

TEST_CASE("a linear field on a plane mesh or a line is exact, without a tolerance, too",
          "[m2m][walls]") {
  const auto linear = [](const Point& p) { return 2 * p[0] - 3 * p[1] + p[2]; };
  WallCase plane{wall_mesh(Wall::plane, 7), wall_mesh(Wall::plane, 9), {}, 3, linear};
  CHECK(errors_of(plane).largest < 1e-12);
  const WallResult result = result_of(plane);
  CHECK(result.tally.count(Status::outside) == 0);
  plane.options.kind = TransferKind::moving_least_squares;
  CHECK(errors_of(plane).largest < 1e-12);
  CHECK(result_of(plane).tally.n_lower_dimension == plane.to.n_points());
  TetMesh line;
  line.dimension = 1;
  for (int i = 0; i <= 10; ++i) line.points.push_back({0.1 * i, 0.2 * i, 0.3});
  for (int i = 0; i < 10; ++i) line.tets.push_back({i, i + 1, i + 1, i + 1});
  TetMesh finer = line;
  for (Point& p : finer.points) p = {0.93 * p[0], 0.93 * p[1], p[2]};
  CHECK(errors_of({line, finer, {}, 3, linear}).largest < 1e-12);
}

TEST_CASE("a wall gives the same bits for any number of pieces and any schedule", "[m2m][walls]") {
  const TetMesh from = wall_mesh(Wall::torus, 5);
  TetMesh to = wall_mesh(Wall::torus, 7, 0.2);
  to.points.insert(to.points.end(), from.points.begin(), from.points.begin() + 40);
  for (std::size_t t = 0; t < 80; ++t) {  // on edges, but for rounding
    const auto c = corners_of(from.points, from.tets[t]);
    to.points.push_back(
        {(c[0][0] + c[1][0]) / 2, (c[0][1] + c[1][1]) / 2, (c[0][2] + c[1][2]) / 2});
  }
  for (const TransferOptions& options :
       {TransferOptions{.kind = TransferKind::projection},
        TransferOptions{.kind = TransferKind::projection, .tolerance = 0.05},
        TransferOptions{.policy = Nearest{}, .tolerance = 0.02},
        TransferOptions{.policy = UseValue{3}}, TransferOptions{.kind = TransferKind::nearest},
        TransferOptions{.kind = TransferKind::moving_least_squares}}) {
    const WallResult one = result_of({from, to, options, 1});
    CHECK(one.tally.n_kept_sources == 1);
    test::for_seeds(2, 2 + test::n_seeds(6), [&](std::uint64_t seed) {
      test::check_same(
          result_of({from, to, options, static_cast<std::int32_t>(1 + seed * 5 % 12)}, seed), one);
    });
  }
}

TEST_CASE("points off a wall are counted, and get what the policy says", "[m2m][walls]") {
  const TetMesh from = wall_mesh(Wall::sphere, 4);
  TetMesh to = wall_mesh(Wall::sphere, 3, 0.2);
  const std::size_t n = to.n_points();
  for (std::size_t v = 0; v < n; v += 2)
    for (double& x : to.points[v]) x *= 3;
  const WallResult some = result_of({from, to, {.policy = UseValue{9}, .tolerance = 0.2}, 3});
  CHECK(some.tally.count(Status::outside) == n - n / 2);
  for (std::size_t v = 0; v < n; ++v) CHECK((some.outcome.values[v] == 9) == (v % 2 == 0));
  const WallResult all = result_of({from, to, {.kind = TransferKind::projection}, 3});
  CHECK(all.tally.count(Status::outside) == 0);
  for (std::size_t v = 0; v < n; v += 2) {
    CHECK(all.outcome.status[v] == Status::snapped);
    CHECK(std::abs(all.outcome.distance[v] - 2) < 0.1);
  }
}

TEST_CASE("a wall takes from a volume, and a volume from a wall", "[m2m][walls]") {
  const auto linear = [](const Point& p) { return p[0] + 2 * p[1] + 4 * p[2]; };
  TetMesh inner = wall_mesh(Wall::sphere, 4);
  for (Point& p : inner.points)
    for (double& x : p) x = 0.5 + 0.45 * x;
  CHECK(errors_of({kuhn_mesh({4, 0.2}), inner, {}, 3, linear}).largest < 1e-12);
  // Beyond the volume: the value at the nearest point of the cube.
  TetMesh outer = inner;
  for (Point& p : outer.points)
    for (double& x : p) x = 0.5 + 3 * (x - 0.5);
  const WallCase c{kuhn_mesh({4, 0.2}), outer, {.kind = TransferKind::projection}, 3, linear};
  const WallResult result = result_of(c);
  for (std::size_t v = 0; v < outer.n_points(); ++v) {
    Point q = outer.points[v];
    for (double& x : q) x = std::min(std::max(x, 0.0), 1.0);
    if (!(std::abs(result.outcome.values[v] - linear(q)) < 1e-12)) FAIL("point " << v);
    if (!(std::abs(result.outcome.distance[v] - collide::length(difference(q, outer.points[v]))) <
          1e-12))
      FAIL("distance of point " << v);
  }
  test::for_seeds(1, 1 + test::n_seeds(4), [&](std::uint64_t seed) {
    WallCase cut = c;
    cut.n_parts = static_cast<std::int32_t>(seed % 4 * 3 + 1);
    test::check_same(result_of(cut, seed), result);
  });
  const WallResult back = result_of({inner, kuhn_mesh({3}), {.kind = TransferKind::projection}, 2});
  CHECK(back.tally.count(Status::outside) == 0);
}

TEST_CASE("the side of a wall is given", "[m2m][walls]") {
  const auto n = static_cast<std::int64_t>(wall_mesh(Wall::sphere, 3).n_points());
  for (const double radius : {0.7, 1.3}) {
    std::int64_t sum = 0;
    CHECK(tests::run("pes=2,cost=100ns", [&] { return sides(radius, sum); }).report.empty());
    CHECK(sum == (radius > 1 ? n : -n));
  }
}

TEST_CASE("values in the cells of a wall go to the cells of another", "[m2m][walls]") {
  const TetMesh wall = wall_mesh(Wall::torus, 4);
  for (const TransferKind kind : {TransferKind::linear, TransferKind::projection}) {
    CellOutcome out;
    CHECK(tests::run("pes=2,cost=100ns", [&] {
            return cells_of_walls(wall, wall, kind, out);
          }).report.empty());
    for (std::size_t t = 0; t < wall.n_tets(); ++t) {
      const auto c = corners_of(wall.points, wall.tets[t]);
      CHECK(out.fields[0].values[t] == c[0][0] + c[1][0] + c[2][0]);
    }
  }
}

TEST_CASE("place() cuts a wall as scatter() does, and measures its area", "[m2m][walls]") {
  const TetMesh wall = wall_mesh(Wall::plane, 6);
  PlacedMesh placed;
  CHECK(tests::run("pes=3,cost=100ns", [&] { return place_wall(wall, placed); }).report.empty());
  CHECK(placed.mesh.dimension == 2);
  CHECK(placed.n_tets == 72);
  const double area = std::sqrt(1 + 0.3 * 0.3 + 0.2 * 0.2);
  CHECK(survey(wall).volume == Approx(area).epsilon(1e-14));
}

TEST_CASE("kinds that a wall does not have are refused in one line", "[m2m][walls]") {
  const TetMesh wall = wall_mesh(Wall::plane, 2), box = kuhn_mesh({1});
  const auto complaint = [](const TetMesh& from, const TetMesh& to, TransferKind kind) {
    WallResult result;
    const WallCase c{from, to, {.kind = kind}};
    return tests::error_of("pes=2,cost=100ns", [&] { return test::run_case(c, result); });
  };
  using Catch::Matchers::Contains;
  for (const TransferKind kind : {TransferKind::second_order, TransferKind::limited})
    CHECK_THAT(complaint(wall, box, kind), Contains("needs tetrahedra; the mesh has triangles"));
  CellOutcome out;
  CHECK_THAT(
      tests::error_of("pes=2,cost=100ns",
                      [&] { return cells_of_walls(wall, wall, TransferKind::limited, out); }),
      Contains("kind limited needs tetrahedra; the mesh has triangles"));
}

TEST_CASE("a mesh of triangles is checked as such", "[m2m][walls]") {
  TetMesh wall = wall_mesh(Wall::plane, 2);
  CHECK(validate(wall).n_flat == 0);
  wall.tets.push_back({0, 1, 1, 1});
  CHECK(validate(wall).n_flat == 1);
  wall.tets[3] = {0, 1, 3, 4};
  wall.name = "wall";
  CHECK_THROWS_WITH(validate(wall),
                    Catch::Matchers::Contains("wall: triangle 3 is (0, 1, 3, 4), but "
                                              "a triangle is (a, b, c, c)"));
  CHECK_THROWS_WITH(mesh_parts(wall, 2, PartitionMethod::curve),
                    Catch::Matchers::Contains("triangle 3 is"));
  wall.tets.assign(8, {0, 1, 1, 1});
  CHECK_THROWS_WITH(validate(wall), Catch::Matchers::Contains("no triangle has an area"));
  wall.dimension = 1;
  CHECK(validate(wall).n_flat == 0);
  wall.dimension = 4;
  CHECK_THROWS_WITH(validate(wall), Catch::Matchers::Contains("has the dimension 4"));
}

TEST_CASE("skins of real meshes onto each other count every point, with the same bits",
          "[m2m][walls][.][shared_data]") {
  std::vector<std::string> files;
  for (const char* folder : {"nalu", "mfem", "skfem"})
    for (const auto& file : std::filesystem::directory_iterator(test::shared_data(folder)))
      if (const auto ending = file.path().extension();
          ending == ".e" || ending == ".exo" || ending == ".msh")
        files.push_back(file.path());
  std::sort(files.begin(), files.end());
  std::vector<TetMesh> skins;
  for (const std::string& file : files) try {
      skins.push_back(skin_of(read_mesh(file)).mesh);
    } catch (const Error&) {  // elements that are not supported
    }
  CHECK(skins.size() >= 15);
  std::uint64_t n_near = 0, n_far = 0;
  for (const TetMesh& from : skins)
    for (const TetMesh& to : skins) {
      INFO(from.name << " -> " << to.name);
      const Aabb box = bounds(from);
      const double size = collide::length(difference(box.hi, box.lo));
      WallCase c{from, to, {.kind = TransferKind::projection, .tolerance = 0.1 * size}, 1};
      const WallResult alone = result_of(c, 0);  // on one PE
      c.n_parts = 5;
      test::check_same(result_of(c, 2), alone);  // on four
      const std::uint64_t n_outside = alone.tally.count(Status::outside);
      CHECK(std::accumulate(alone.tally.counts.begin(), alone.tally.counts.end(), n_outside * 0) ==
            to.n_points());
      if (&from == &to) CHECK(alone.tally.count(Status::boundary) == to.n_points());
      n_far += n_outside;
      n_near += to.n_points() - n_outside;
    }
  CHECK((n_near > 0 && n_far > 0));
}

TEST_CASE("time of a search and an application between walls", "[.][benchmark][walls]") {
  for (const double offset : {0.0, 0.2})
    for (const TransferOptions& options :
         {TransferOptions{.kind = TransferKind::projection}, TransferOptions{.tolerance = 0.3}})
      CHECK(tests::run_threads(1, [&] { return time_walls(offset, options); }).exit_code == 0);
}
