#include "m2m/rows/conservative/overlap_rows.hpp"

#include "m2m/kuhn.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numeric>

using namespace tess::m2m;
using tess::test::overlapping_pairs, tess::test::rows_between, tess::test::TetPair,
    tess::test::view;

namespace {

/// The unknowns of a linear function. A cell gets the value at its centroid, its mean.
std::vector<double> linear_field(const TetMesh& mesh, Centring centring) {
  const auto f = [](const Point& p) { return 2 + 3 * p[0] - p[1] + 0.5 * p[2]; };
  std::vector<double> values;
  if (centring == Centring::nodes)
    for (const Point& p : mesh.points) values.push_back(f(p));
  for (const Tet& tet : mesh.tets) {
    const Corners c = corners_of(mesh.points, tet);
    if (centring == Centring::corners)
      for (const Point& p : c) values.push_back(f(p));
    if (centring == Centring::cells) values.push_back((f(c[0]) + f(c[1]) + f(c[2]) + f(c[3])) / 4);
  }
  return values;
}

}  // namespace

TEST_CASE("weights are the integrals over all pairs of tetrahedra, in columns by id",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({4, 0.2}), b = kuhn_mesh({5, 0.15});
  const Rows<double> rows = rows_between(a, Centring::nodes, b, Centring::nodes).rows;
  std::map<std::array<VertexId, 2>, double> want;
  for (const TetPair& pair : overlapping_pairs(view(a), view(b))) {
    const Tet &s = a.tets[static_cast<std::size_t>(pair.source)],
              &t = b.tets[static_cast<std::size_t>(pair.target)];
    const PairMoments moments = pair_moments(corners_of(a.points, s), corners_of(b.points, t));
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) want[{t[j], s[i]}] += moments.mixed[i][j];
  }
  REQUIRE(rows.n_rows() == b.n_points());
  for (std::size_t row = 0; row < rows.n_rows(); ++row) {
    VertexId last = -1;
    for (std::uint64_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k) {
      double& rest = want[{static_cast<VertexId>(row), rows.columns[k]}];
      rest -= rows.weights[k];
      if (rows.columns[k] <= last || !(rows.weights[k] > 0)) FAIL(row);
      last = rows.columns[k];
    }
  }
  for (const auto& [entry, rest] : want)
    if (std::abs(rest) > 1e-16) FAIL(entry[0] << ", " << entry[1] << ": " << rest);
}

TEST_CASE("weights have the same bits for any order and any cut of the source",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({8, 0.2}), b = kuhn_mesh({9, 0.2});
  const Rows<double> all = rows_between(a, Centring::nodes, b, Centring::nodes).rows;
  std::map<std::array<std::size_t, 2>, double> sums;
  for (std::size_t part = 0; part < 3; ++part) {
    TetMesh mine = a;
    mine.tets.clear();
    for (std::size_t t = a.n_tets(); t-- > 0;)
      if (t % 3 == part) mine.tets.push_back(a.tets[t]);
    const Rows<double> rows = rows_between(mine, Centring::nodes, b, Centring::nodes).rows;
    for (std::size_t row = 0; row < rows.n_rows(); ++row)
      for (std::uint64_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k)
        sums[{row, static_cast<std::size_t>(rows.columns[k])}] += rows.weights[k];
  }
  std::size_t n_wrong = 0;
  for (std::size_t row = 0; row < all.n_rows(); ++row)
    for (std::uint64_t k = all.begin[row]; k < all.begin[row + 1]; ++k)
      if (sums[{row, static_cast<std::size_t>(all.columns[k])}] != all.weights[k]) ++n_wrong;
  CHECK(n_wrong == 0);
  CHECK(sums.size() == all.weights.size());
  CHECK(all.weights.size() > 20000);
}

TEST_CASE("loads of every pair of centrings add up to the integral of the source",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({5, 0.2}), b = kuhn_mesh({4, 0.1});
  for (const Centring from : {Centring::nodes, Centring::cells, Centring::corners})
    for (const Centring to : {Centring::nodes, Centring::cells}) {
      const Rows<double> rows = rows_between(a, from, b, to).rows;
      std::vector<double> loads(rows.n_rows());
      apply(rows, linear_field(a, from), 1, loads);
      CAPTURE(static_cast<int>(from), static_cast<int>(to));
      CHECK(loads.size() == (to == Centring::nodes ? b.n_points() : b.n_tets()));
      CHECK(std::abs(std::accumulate(loads.begin(), loads.end(), 0.0) - 3.25) < 1e-13);
    }
}

TEST_CASE("loads over the volume are the means of linear functions on any pair of meshes",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({4, 0.2}), b = kuhn_mesh({7, 0.15});
  const std::vector<double> want = linear_field(b, Centring::cells);
  for (const Centring from : {Centring::nodes, Centring::corners}) {
    std::vector<double> loads(b.n_tets());
    apply(rows_between(a, from, b, Centring::cells).rows, linear_field(a, from), 1, loads);
    for (std::size_t t = 0; t < want.size(); ++t)
      if (!(std::abs(loads[t] / signed_volume(b, t) - want[t]) < 1e-12)) FAIL(t);
  }
}

TEST_CASE("loads of the constant 1 are the sums of the weights, bit for bit",
          "[m2m][conservative]") {
  TetMesh a = kuhn_mesh({4, 0.2});
  for (Point& p : a.points) p[0] *= 0.6;
  const TetMesh b = kuhn_mesh({5, 0.2});
  const OverlapRows rows = rows_between(a, Centring::nodes, b, Centring::nodes);
  std::vector<double> sums(b.n_points()), want(b.n_points());
  apply(rows.rows, std::vector<double>(a.n_points(), 1), 1, sums);
  const auto covered = tess::test::covered_by(rows, b);
  for (std::size_t t = 0; t < b.n_tets(); ++t)
    for (std::size_t c = 0; c < 4; ++c)
      want[static_cast<std::size_t>(b.tets[t][c])] += covered[t][c];
  CHECK(sums == want);
  CHECK(std::abs(std::accumulate(want.begin(), want.end(), 0.0) - 0.6) < 1e-14);
}
