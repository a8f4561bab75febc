// Meshes, and pieces of an application's mesh, are checked before a search.
#include "m2m/mesh/checks/mesh_findings.hpp"
#include "m2m/mesh_view.hpp"
#include "runtime/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace tess::m2m;

namespace {

/// One tetrahedron, whose view a test changes.
struct OneTet {
  std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Tet> tets{{0, 1, 2, 3}};
  std::vector<GlobalId> point_ids{10, 11, 12, 13}, tet_ids{70};
  std::int64_t n_owned = 4, n_own_tets = -1;

  [[nodiscard]] std::string complaint() const {
    return tess::test::message_of([&] {
      validate({points, tets, point_ids, tet_ids, n_owned, n_own_tets});
    });
  }
};

}  // namespace

TEST_CASE("a piece with bad coordinates, indices or counts is refused by name", "[m2m]") {
  CHECK(OneTet().complaint().empty());
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           -std::numeric_limits<double>::infinity(), 2e100}) {
    OneTet piece;
    piece.points[2][1] = bad;
    CHECK_THAT(piece.complaint(), Contains("point 2 of a piece, with the id 12, has"));
  }
  for (const VertexId bad : {-1, 4}) {
    OneTet piece;
    piece.tets[0][3] = bad;
    CHECK_THAT(piece.complaint(),
               Contains("tetrahedron 0 of a piece, with the id 70, names point"));
  }
  OneTet too_many;
  too_many.n_owned = 5;
  CHECK_THAT(too_many.complaint(), Contains("owns 5 of 4 points"));
  OneTet halo;
  halo.n_own_tets = 2;
  CHECK_THAT(halo.complaint(), Contains("2 own tetrahedra of 1"));
  halo.n_own_tets = -2;
  CHECK_THAT(halo.complaint(), Contains("-2 own tetrahedra of 1"));
  OneTet no_ids;
  no_ids.tet_ids.clear();
  CHECK_THAT(no_ids.complaint(), Contains("0 tet_ids"));
}

TEST_CASE("of several findings the first is named, in whatever order ranges are looked at",
          "[m2m]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Point> points(10);
  for (const std::size_t v : {2U, 3U, 7U}) points[v][1] = nan;
  std::vector<Tet> tets(10, Tet{0, 1, 4, 5});
  for (const std::size_t t : {1U, 4U, 8U}) tets[t][3] = 10;
  // Three ranges, two of which have findings of each kind.
  const auto range = [&](std::size_t first, std::size_t n) {
    MeshFindings found;
    const auto id = static_cast<GlobalId>(first);
    found.add_points(id, std::span(points).subspan(first, n));
    found.add_corners(id, std::span(tets).subspan(first, n), 10);
    for (std::size_t t = first + n; t-- > first;)
      if (t != 5) found.add_shape(static_cast<GlobalId>(t), {});  // of no extent
    return found;
  };
  std::vector<std::size_t> order{0, 1, 2};
  do {
    MeshFindings all;
    for (const std::size_t i : order) all.join(i == 0 ? range(0, 5) : range(4 + i, i == 1 ? 1 : 4));
    CHECK(all.bad_point.point == 2);
    CHECK(all.bad_corner.tet == 1);
    CHECK(all.collapsed.tet == 0);
    CHECK(all.n_collapsed == 9);
    CHECK_THROWS_WITH(all.refuse_bad_ids("m", 10), Contains("m: vertex 2 has y = nan"));
    CHECK_THROWS_WITH(all.refuse_bad_shapes("m", 10), Contains("9 of 10 tetrahedra"));
  } while (std::next_permutation(order.begin(), order.end()));
}
