#include "m2m/conservative/overlaps.hpp"

#include "m2m/kuhn.hpp"
#include "tests/m2m/overlapping.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

using namespace tess::m2m;
using tess::test::loads_of;
using tess::test::overlapping_pairs;
using tess::test::overlaps_of;
using tess::test::TetPair;
using tess::test::view;

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

TEST_CASE("overlaps are all pairs with a volume in common, by target and source id",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({4, 0.2}), b = kuhn_mesh({5, 0.15});
  const Overlaps found = overlaps_of(a, b);
  std::vector<std::pair<std::uint32_t, std::int32_t>> got, want;
  for (std::size_t t = 0; t < found.targets.size(); ++t)
    for (std::uint32_t k = found.first[t]; k < found.first[t + 1]; ++k)
      got.emplace_back(found.targets[t], found.sources[k]);
  for (const TetPair& pair : overlapping_pairs(view(a), view(b)))
    if (overlap_volume(corners_of(a.points, a.tets[static_cast<std::size_t>(pair.source)]),
                       corners_of(b.points, b.tets[static_cast<std::size_t>(pair.target)])) > 0)
      want.emplace_back(static_cast<std::uint32_t>(pair.target), pair.source);
  std::sort(want.begin(), want.end());
  CHECK(got.size() > 3000);
  CHECK(got == want);
  CHECK(found.integrals.size() == want.size());
}

TEST_CASE("loads of every centring add up to the integral of the source", "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({5, 0.2}), b = kuhn_mesh({4, 0.1});
  const Overlaps overlaps = overlaps_of(a, b);
  for (const Centring centring : {Centring::nodes, Centring::cells, Centring::corners}) {
    const std::vector<double> field = linear_field(a, centring);
    const std::vector<double> loads = loads_of(overlaps, a, b, {field, 1, centring});
    CAPTURE(static_cast<int>(centring));
    CHECK(std::abs(std::accumulate(loads.begin(), loads.end(), 0.0) - 3.25) < 1e-13);
  }
}

TEST_CASE("loads over the volume are the means of linear functions on any pair of meshes",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({4, 0.2}), b = kuhn_mesh({7, 0.15});
  const Overlaps overlaps = overlaps_of(a, b);
  const std::vector<double> want = linear_field(b, Centring::cells);
  for (const Centring centring : {Centring::nodes, Centring::corners}) {
    const std::vector<double> field = linear_field(a, centring);
    const std::vector<double> loads = loads_of(overlaps, a, b, {field, 1, centring});
    for (std::size_t t = 0; t < want.size(); ++t) {
      const double load = loads[4 * t] + loads[4 * t + 1] + loads[4 * t + 2] + loads[4 * t + 3];
      if (!(std::abs(load / signed_volume(b, t) - want[t]) < 1e-12)) FAIL(t);
    }
  }
}

TEST_CASE("ranges are those of the source tetrahedra that overlap, without NaN",
          "[m2m][conservative]") {
  const TetMesh a = kuhn_mesh({2});
  std::vector<double> values(a.n_points(), 5);
  const Tet& tet = a.tets[7];
  values[static_cast<std::size_t>(tet[0])] = -1;
  values[static_cast<std::size_t>(tet[1])] = NAN;
  std::vector<ValueRange> range{{3, 4}};
  add_range(view(a), 7, {values, 1, Centring::nodes}, range);
  CHECK(range.front() == ValueRange{-1, 5});
}
