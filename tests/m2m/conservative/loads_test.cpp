#include "m2m/conservative/loads.hpp"

#include "m2m/kuhn.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numeric>

using namespace tess::m2m;
using tess::test::overlapping_pairs;
using tess::test::view;

namespace {

std::vector<double> loads_of(const Rows<double>& rows, const std::vector<double>& values) {
  std::vector<double> out(rows.n_rows());
  apply(rows, values, 1, out);
  return out;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::size_t n_unknowns(const TetMesh& mesh, Basis basis) {
  if (basis == Basis::vertex) return mesh.n_points();
  return basis == Basis::cell ? mesh.n_tets() : 4 * mesh.n_tets();
}

/// The unknowns of a linear function. A cell gets the value at its centroid, its mean.
std::vector<double> linear_field(const TetMesh& mesh, Basis basis) {
  const auto f = [](const Point& p) { return 2 + 3 * p[0] - p[1] + 0.5 * p[2]; };
  std::vector<double> values;
  if (basis == Basis::vertex)
    for (const Point& p : mesh.points) values.push_back(f(p));
  for (const Tet& tet : mesh.tets) {
    const Corners c = corners_of(mesh.points, tet);
    if (basis == Basis::corner)
      for (const Point& p : c) values.push_back(f(p));
    if (basis == Basis::cell) values.push_back((f(c[0]) + f(c[1]) + f(c[2]) + f(c[3])) / 4);
  }
  return values;
}

}  // namespace

TEST_CASE("loads of every pair of bases add up to the integral of the source",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({5, 0.2}), b = kuhn_mesh({4, 0.1});
  const auto pairs = overlapping_pairs(view(a), view(b));
  for (const Basis source : {Basis::vertex, Basis::cell, Basis::corner}) {
    for (const Basis target : {Basis::vertex, Basis::cell, Basis::corner}) {
      const Loads loads = integrate_pairs(view(a), source, view(b), target, pairs);
      CHECK(loads.rows.n_rows() == n_unknowns(b, target));
      const std::vector<double> load = loads_of(loads.rows, linear_field(a, source));
      CAPTURE(static_cast<int>(source), static_cast<int>(target));
      CHECK(std::abs(sum(load) - 3.25) < 1e-13);  // 2 + 3/2 - 1/2 + 1/4
      for (const double weight : loads.rows.weights)
        if (weight < -1e-17) FAIL("weight " << weight);
    }
  }
}

TEST_CASE("means of cells are exact for linear functions on any pair of meshes",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({4, 0.2}), b = kuhn_mesh({7, 0.15});
  const auto pairs = overlapping_pairs(view(a), view(b));
  for (const Basis source : {Basis::vertex, Basis::corner}) {
    const Loads loads = integrate_pairs(view(a), source, view(b), Basis::cell, pairs);
    std::vector<double> means = loads_of(loads.rows, linear_field(a, source));
    cell_means(view(b), loads.coverage, 1, NAN, means);
    const std::vector<double> want = linear_field(b, Basis::cell);
    for (std::size_t t = 0; t < want.size(); ++t)
      if (!(std::abs(means[t] - want[t]) < 1e-12)) FAIL(t << ": " << means[t] - want[t]);
  }
}

TEST_CASE("cells that the source covers in part are reported, and the others get the fallback",
          "[m2m][conservative]") {
  // The source covers x < 0.5 of the target, through the middle of its tetrahedra.
  TetMesh a = kuhn_mesh({4});
  for (Point& p : a.points) p[0] *= 0.5;
  const TetMesh b = kuhn_mesh({3});
  const Loads loads = integrate_pairs(view(a), Basis::vertex, view(b), Basis::cell,
                                      overlapping_pairs(view(a), view(b)));
  const std::vector<double> fractions = covered_fractions(b.points, b.tets, loads.coverage);
  std::vector<double> means = loads_of(loads.rows, std::vector<double>(a.n_points(), 7.0));
  cell_means(view(b), loads.coverage, 1, -1.0, means);
  double covered = 0;
  std::size_t n_whole = 0, n_part = 0, n_none = 0;
  for (std::size_t t = 0; t < b.n_tets(); ++t) {
    covered += fractions[t] * signed_volume(b, t);
    n_whole += fractions[t] > 1 - full_coverage;
    n_none += fractions[t] == 0;
    n_part += fractions[t] > 0 && fractions[t] <= 1 - full_coverage;
    CHECK(means[t] == Approx(fractions[t] > 0 ? 7.0 : -1.0).epsilon(1e-12));
  }
  CHECK(std::abs(covered - 0.5) < 1e-13);
  CHECK(n_whole == 54);  // a third of the cubes are to the left, a third cut, a third to the right
  CHECK(n_part == 54);
  CHECK(n_none == 54);
}

TEST_CASE("rows and coverage of parts of the source add up to those of the whole",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({4, 0.2}), b = kuhn_mesh({3, 0.2});
  const auto pairs = overlapping_pairs(view(a), view(b));
  const std::vector<double> field = linear_field(a, Basis::vertex);
  const Loads all = integrate_pairs(view(a), Basis::vertex, view(b), Basis::vertex, pairs);
  std::vector<double> total(b.n_points(), 0.0);
  std::vector<CellCoverage> coverage(b.n_tets());
  for (std::int32_t part = 0; part < 3; ++part) {
    std::vector<TetPair> mine;
    for (const TetPair& pair : pairs)
      if (pair.source % 3 == part) mine.push_back(pair);
    const Loads loads = integrate_pairs(view(a), Basis::vertex, view(b), Basis::vertex, mine);
    const std::vector<double> load = loads_of(loads.rows, field);
    for (std::size_t v = 0; v < total.size(); ++v) total[v] += load[v];
    for (std::size_t t = 0; t < coverage.size(); ++t) coverage[t] += loads.coverage[t];
  }
  const std::vector<double> want = loads_of(all.rows, field);
  for (std::size_t v = 0; v < total.size(); ++v) CHECK(total[v] == Approx(want[v]).epsilon(1e-13));
  for (std::size_t t = 0; t < coverage.size(); ++t)
    CHECK(coverage[t].volume == Approx(signed_volume(b, t)).epsilon(1e-13));
}

TEST_CASE("weights are the sums over pairs in their order, bit for bit, however many there are",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({8, 0.2}), b = kuhn_mesh({9, 0.2});
  const auto pairs = overlapping_pairs(view(a), view(b));
  const Loads loads = integrate_pairs(view(a), Basis::vertex, view(b), Basis::vertex, pairs);
  CHECK(16 * loads.n_overlaps > 3 * (1U << 18));  // more than are kept without a merge
  std::map<std::array<VertexId, 2>, double> want;
  for (const TetPair& pair : pairs) {
    const Tet &s = a.tets[static_cast<std::size_t>(pair.source)],
              &t = b.tets[static_cast<std::size_t>(pair.target)];
    const PairMoments moments = pair_moments(corners_of(a.points, s), corners_of(b.points, t));
    if (!(moments.volume > 0)) continue;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) want[{t[j], s[i]}] += moments.mixed[i][j];
  }
  REQUIRE(loads.rows.weights.size() == want.size());
  std::size_t k = 0, n_wrong = 0;
  for (const auto& [entry, weight] : want) {
    n_wrong += loads.rows.columns[k] != entry[1] || loads.rows.weights[k] != weight;
    ++k;
  }
  CHECK(n_wrong == 0);
}
