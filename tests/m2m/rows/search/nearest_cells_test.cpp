#include "m2m/rows/search/nearest_cells.hpp"

#include "collide/distance.hpp"
#include "m2m/kuhn.hpp"
#include "tests/m2m/walls.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <numeric>
#include <random>

using namespace tess::m2m;
using tess::test::Wall;

namespace {

struct NumberedCells {
  TetMesh mesh;
  std::vector<GlobalId> ids = std::vector<GlobalId>(mesh.n_tets());

  explicit NumberedCells(TetMesh of) : mesh(std::move(of)) {
    // The last cell has the lowest id.
    for (std::size_t t = 0; t < ids.size(); ++t) ids[ids.size() - 1 - t] = static_cast<GlobalId>(t);
  }
  [[nodiscard]] MeshView view() const {
    return {mesh.points, mesh.tets, {}, ids, 0, -1, mesh.dimension};
  }
  [[nodiscard]] std::array<Point, 4> corners(std::size_t cell) const {
    return corners_of(mesh.points, mesh.tets[cell]);
  }
};

/// Near to a wall and far, and on its corners, its edges and its faces but for rounding.
std::vector<Point> queries(const TetMesh& wall) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  std::vector<Point> points{{1e9, 3, -1e9}, {0, 0, 0}};
  for (int k = 0; k < 300; ++k) points.push_back({place(random), place(random), place(random)});
  for (std::size_t t = 0; t < wall.n_tets(); t += 3) {
    const auto c = corners_of(wall.points, wall.tets[t]);
    points.push_back(c[0]);
    Point middle{}, centre{};
    for (std::size_t k = 0; k < 3; ++k) {
      middle[k] = (c[0][k] + c[1][k]) / 2;
      centre[k] = (c[0][k] + c[1][k] + c[2][k]) / 3;
    }
    points.push_back(middle);
    points.push_back(centre);
  }
  return points;
}

/// The best of all cells within the reach; empty if there is none.
std::optional<std::pair<std::size_t, double>> by_force(const NumberedCells& cells, const Point& p,
                                                       double reach) {
  std::optional<std::pair<std::size_t, double>> best;
  Candidate of_best;
  for (std::size_t t = 0; t < cells.mesh.n_tets(); ++t) {
    const Location at = location_of(foot_of(p, cells.corners(t), cells.mesh.dimension), p,
                                    cells.corners(t), cells.mesh.dimension);
    const Candidate candidate = candidate_of(at, cells.ids[t]);
    if (at.distance > reach || !better(candidate, of_best)) continue;
    of_best = candidate;
    best = {t, at.distance};
  }
  return best;
}

}  // namespace

TEST_CASE("the nearest cell is that of brute force, and ties go to the lowest id",
          "[m2m][nearest]") {
  std::vector<NumberedCells> meshes;
  for (const Wall wall : {Wall::plane, Wall::sphere, Wall::torus})
    meshes.emplace_back(tess::test::wall_mesh(wall, 5, 0.1));
  meshes.emplace_back(tess::test::circle_mesh(40, 0.1));
  for (const NumberedCells& cells : meshes) {
    const NearestCells tree(cells.view());
    const std::vector<Point> points = queries(cells.mesh);
    std::uint64_t n_tested = 0;
    const BestDonors all =
        tree.within(cells.view(), points, std::vector<double>(points.size(), INFINITY), n_tested);
    REQUIRE(all.points.size() == points.size());
    int n_ties = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto want = by_force(cells, points[i], INFINITY);
      if (std::cmp_not_equal(all.tets[i], want->first))
        FAIL("point " << i << " not " << want->first);
      if (all.candidates[i].distance != want->second) FAIL("distance of point " << i);
      for (std::size_t t = 0; t < cells.mesh.n_tets(); ++t)
        n_ties += t != want->first &&
                          foot_of(points[i], cells.corners(t), cells.mesh.dimension).distance ==
                              want->second
                      ? 1
                      : 0;
      const std::array<double, 2> reaches{want->second, std::nextafter(want->second, -1)};
      const std::array<Point, 2> twice{points[i], points[i]};
      if (tree.within(cells.view(), twice, reaches, n_tested).points !=
          std::vector<std::uint32_t>{0})
        FAIL("reach of point " << i);
    }
    CHECK(n_ties > 10);
    CHECK(n_tested < 40 * 3 * points.size());
  }
}

TEST_CASE("distances from a wall are those of its triangles by exact numbers", "[m2m][nearest]") {
  const NumberedCells cells(tess::test::wall_mesh(Wall::torus, 6));
  const std::vector<Point> points = queries(cells.mesh);
  std::uint64_t n_tested = 0;
  const BestDonors found =
      NearestCells(cells.view())
          .within(cells.view(), points, std::vector<double>(points.size(), INFINITY), n_tested);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double want = INFINITY;
    for (std::size_t t = 0; t < cells.mesh.n_tets(); ++t) {
      const auto c = cells.corners(t);
      want = std::min(
          want, tess::collide::distance2(tess::collide::Triangle{{c[0], c[1], c[2]}}, points[i]));
    }
    want = std::sqrt(want);
    if (!(std::abs(found.candidates[i].distance - want) < 1e-15 + 1e-12 * want)) FAIL(i);
  }
}

TEST_CASE("a point snaps within the tolerance, or within rounding of a cell", "[m2m][nearest]") {
  const NumberedCells cells(tess::test::wall_mesh(Wall::plane, 4));
  const NearestCells tree(cells.view());
  std::vector<Point> points{{0.3, 0.3, 0.15}, {0.3, 0.3, 0.15 + 1e-11}, {0.3, 0.3, 0.16}};
  std::uint64_t n_tested = 0;
  CHECK(tree.snapped(cells.view(), points, 0, n_tested).points == std::vector<std::uint32_t>{0, 1});
  const BestDonors all = tree.snapped(cells.view(), points, 0.01, n_tested);
  REQUIRE(all.points.size() == 3);
  CHECK(all.candidates[2].status == Status::snapped);
  CHECK(all.candidates[2].side == 1);
}

TEST_CASE("the nearest tetrahedron of a point outside is that of brute force", "[m2m][nearest]") {
  const NumberedCells cells(kuhn_mesh({3, 0.2}));
  std::vector<Point> points;
  for (const Point& p : kuhn_mesh({5}).points)
    if (p[0] == 0 || p[1] == 1) points.push_back({2 * p[0] - 0.5, 3 * p[1] - 1, p[2] * 1.5 - 0.1});
  std::erase_if(points, [](const Point& p) { return p[0] >= 0 && p[1] >= 0 && p[1] <= 1; });
  std::uint64_t n_tested = 0;
  const BestDonors found =
      NearestCells(cells.view())
          .within(cells.view(), points, std::vector<double>(points.size(), INFINITY), n_tested);
  REQUIRE(found.points.size() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    CHECK(std::cmp_equal(found.tets[i], by_force(cells, points[i], INFINITY)->first));
}
