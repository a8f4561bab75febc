// Covers, the grid of points, and the narrow phase of a search, against all pairs.
#include "m2m/kuhn.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/rows/search/best_donors.hpp"
#include "m2m/rows/search/box_block.hpp"
#include "m2m/rows/search/point_grid.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

using namespace tess::m2m;
using tess::collide::Touching;

namespace {

/// Random points in a box of very different sides, moved far from the origin; some equal.
std::vector<Point> random_points(std::size_t n, const Point& sides, double offset) {
  std::mt19937_64 random(n);
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<Point> points;
  for (std::size_t i = 0; i < n; ++i) {
    Point p{};
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = offset + sides[axis] * part(random);
    points.push_back(i % 7 == 3 ? points.back() : p);
  }
  return points;
}

struct Cloud {
  Point sides;
  double offset;
};
const std::vector<Cloud> clouds{{{1, 1, 1}, 0},
                                {{1, 0, 1}, -5},
                                {{1e6, 1, 1e-6}, 0},
                                {{0, 0, 0}, 3},
                                {{1e-90, 1e-90, 1e-90}, 0},
                                {{1e90, 1, 1e90}, 0},
                                {{1, 1, 1e-12}, 1e12}};

BestDonors donors_of_list(const MeshView& mesh, const Cover& cover,
                          std::span<const std::uint32_t> boxes, std::span<const Point> points,
                          double tolerance, std::uint64_t& n_tested) {
  return best_donors(mesh, cover, boxes, std::vector{points}, tolerance, n_tested).at(0);
}

}  // namespace

TEST_CASE("a cover lists each object once, in a box that contains it", "[m2m]") {
  for (const Cloud& cloud : clouds)
    for (const std::size_t n :
         {std::size_t{0}, std::size_t{1}, std::size_t{65}, std::size_t{5000}}) {
      INFO(n << " points in " << cloud.sides[0] << " x " << cloud.sides[1] << " x "
             << cloud.sides[2]);
      const std::vector<Point> points = random_points(n, cloud.sides, cloud.offset);
      const Cover cover = cover_points(points);
      std::vector<int> times(n);
      bool contained = true;
      for (std::uint32_t box = 0; box < cover.boxes.size(); ++box)
        for (const std::uint32_t i : cover.members_of(box)) {
          ++times[i];
          contained = contained &&
                      overlap(cover.boxes[box], tess::collide::box_of(points[i]), Touching::counts);
        }
      CHECK(contained);
      CHECK(std::all_of(times.begin(), times.end(), [](int t) { return t == 1; }));
      CHECK(cover.boxes.size() <= 8 * (n / 64 + 1));
    }
}

TEST_CASE("a cover of tetrahedra contains the search box of each", "[m2m]") {
  for (const double offset : {0.0, 1e9}) {
    TetMesh mesh = read_mesh("kuhn:7@0.2");
    for (Point& p : mesh.points) p[1] += offset;
    const Cover cover = cover_tets(mesh.points, mesh.tets);
    std::size_t n = 0;
    bool contained = true;
    for (std::uint32_t box = 0; box < cover.boxes.size(); ++box)
      for (const std::uint32_t t : cover.members_of(box)) {
        ++n;
        const Aabb tet = search_box(corners_of(mesh.points, mesh.tets[t]));
        contained = contained && merged(cover.boxes[box], tet) == cover.boxes[box];
      }
    CHECK(contained);
    CHECK(n == mesh.n_tets());
  }
}

TEST_CASE("a grid of points finds those in a box", "[m2m]") {
  for (const Cloud& cloud : clouds) {
    const std::vector<Point> points = random_points(700, cloud.sides, cloud.offset);
    const PointGrid grid(points);
    std::size_t n_found = 0;
    for (std::size_t i = 0; i + 1 < points.size(); i += 20) {
      const Aabb box =
          merged(tess::collide::box_of(points[i]), tess::collide::box_of(points[i + 1]));
      std::vector<std::uint32_t> found, want;
      grid.visit_rows(box, [&](std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t at = first; at < last; ++at)
          if (grid.is_in(static_cast<std::int32_t>(at), box)) found.push_back(grid.numbers()[at]);
        return true;
      });
      for (std::uint32_t k = 0; k < points.size(); ++k)
        if (overlap(box, tess::collide::box_of(points[k]), Touching::counts)) want.push_back(k);
      std::vector<std::uint32_t> listed(want.size() + 1);
      listed.resize(grid.list_in(box, listed));
      for (std::uint32_t& at : listed) at = grid.numbers()[at];
      REQUIRE(listed == found);
      std::vector<std::uint32_t> too_short(want.size() - 1);
      REQUIRE(grid.list_in(box, too_short) == want.size());
      std::sort(found.begin(), found.end());
      REQUIRE(found == want);
      n_found += found.size();
    }
    CHECK(n_found >= 70);  // each box has its two corners
  }
}

TEST_CASE("a block of boxes names those that hold a point", "[m2m]") {
  TetMesh mesh = read_mesh("kuhn:4@0.2");
  for (const double offset : {0.0, 1e9}) {
    for (Point& p : mesh.points) p[2] += offset;
    for (const std::size_t n : {std::size_t{1}, std::size_t{17}, BoxBlock::capacity}) {
      std::vector<std::uint32_t> members;
      for (std::uint32_t i = 0; i < n; ++i) members.push_back(i * 5);
      BoxBlock block;
      block.load(mesh.points, mesh.tets, members);
      block.make_slabs();
      std::size_t n_found = 0, n_maybe = 0;
      std::vector<Point> points = random_points(300, {1.2, 1.2, 1.2}, -0.1);
      for (Point& p : points) p[2] += offset;
      for (const std::uint32_t t : members) {  // within the padding of a box
        const Aabb box = tess::collide::box_around(corners_of(mesh.points, mesh.tets[t]));
        points.push_back({box.lo[0] - 1e-11, box.hi[1], box.hi[2]});
      }
      for (const Point& p : points) {
        for (std::size_t i = 0; i < BoxBlock::capacity; ++i) {
          const bool maybe = (block.maybe_holding(p) >> i & 1) != 0;
          const bool holds = i < n && overlap(padded(tess::collide::box_around(
                                                  corners_of(mesh.points, mesh.tets[members[i]]))),
                                              tess::collide::box_of(p), Touching::counts);
          REQUIRE((maybe || !holds));
          REQUIRE((maybe && block.holds(i, p)) == holds);
          REQUIRE((block.holding(p) >> i & 1) == (holds ? 1 : 0));
          n_found += holds ? 1 : 0;
          n_maybe += maybe ? 1 : 0;
        }
      }
      CHECK(n_found > 0);
      if (n == BoxBlock::capacity) CHECK(n_maybe < 2 * n_found);
    }
  }
}

TEST_CASE("the narrow phase finds the best tetrahedron of each point among all", "[m2m]") {
  const TetMesh mesh = read_mesh("kuhn:6@0.2");
  std::vector<GlobalId> ids(mesh.n_tets());
  std::iota(ids.begin(), ids.end(), 1000);
  std::reverse(ids.begin(), ids.end());  // ties go to the lowest id, not to the first
  const MeshView view{mesh.points, mesh.tets, {}, ids, 0};
  const Cover cover = cover_tets(mesh.points, mesh.tets);
  std::vector<std::uint32_t> all(cover.boxes.size());
  std::iota(all.begin(), all.end(), 0U);
  // Vertices lie in several tetrahedra.
  for (const std::size_t n : {std::size_t{30}, std::size_t{3000}}) {
    std::vector<Point> points = random_points(n, {1.2, 1.2, 1.2}, -0.1);
    points.insert(points.end(), mesh.points.begin(), mesh.points.begin() + 100);
    std::uint64_t n_tested = 0;
    const BestDonors best = donors_of_list(view, cover, all, points, 0, n_tested);
    std::map<std::uint32_t, std::size_t> at;
    for (std::size_t i = 0; i < best.points.size(); ++i) at[best.points[i]] = i;
    std::size_t n_inside = 0;
    for (std::uint32_t p = 0; p < points.size(); ++p) {
      Candidate want;
      Donor donor;
      for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
        const auto location = locate(points[p], corners_of(mesh.points, mesh.tets[t]));
        if (!location || !better(candidate_of(*location, ids[t]), want)) continue;
        want = candidate_of(*location, ids[t]);
        donor = {mesh.tets[t], location->weights};
      }
      REQUIRE(at.contains(p) == (want.status != Status::outside));
      if (!at.contains(p)) continue;
      ++n_inside;
      REQUIRE(best.candidates[at[p]].tet == want.tet);
      REQUIRE(best.donors[at[p]].vertices == donor.vertices);
      REQUIRE(best.donors[at[p]].weights == donor.weights);
    }
    CHECK(n_inside > n / 3);
    CHECK(n_inside < points.size());
  }
}

TEST_CASE("a point snaps to the same tetrahedron whether one piece has all or each has one",
          "[m2m]") {
  // The points are within rounding of the first one, within the tolerance of both, and nearer to
  // the second.
  constexpr double gap = 1.2e-11;
  const std::vector<Point> corners{
      {0, 0, 0},       {1, 0, 0},         {0, 1, 0},         {0.3, 0.3, -1},
      {0.3, 0.3, gap}, {0.301, 0.3, gap}, {0.3, 0.301, gap}, {0.3003, 0.3003, 0.001}};
  const std::vector<Tet> tets{{0, 1, 2, 3}, {4, 5, 6, 7}};
  const std::vector<GlobalId> ids{1, 0};
  const std::vector<Point> points{{0.3002, 0.3002, 8e-12}, {0.30025, 0.3002, 7e-12}};
  std::uint64_t n_tested = 0;
  const auto snapped = [&](std::size_t first, std::size_t n) {
    const MeshView view{
        corners, std::span(tets).subspan(first, n), {}, std::span(ids).subspan(first, n), 0};
    const Cover cover = cover_tets(view.points, view.tets, 1e-9);
    std::vector<std::uint32_t> all(cover.boxes.size());
    std::iota(all.begin(), all.end(), 0U);
    return donors_of_list(view, cover, all, points, 1e-9, n_tested);
  };
  const BestDonors whole = snapped(0, 2), alone = snapped(1, 1);
  REQUIRE(whole.points.size() == points.size());
  REQUIRE(alone.points.size() == points.size());
  REQUIRE(donors_of_list({corners, std::span(tets).first(1), {}, std::span(ids).first(1), 0},
                         cover_tets(corners, std::span(tets).first(1)),
                         std::vector<std::uint32_t>{0}, points, 0, n_tested)
              .points.size() == points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(whole.candidates[i].tet == 0);
    CHECK(whole.donors[i].weights == alone.donors[i].weights);
  }
}

TEST_CASE("the narrow phase looks only at the boxes of the cover that it is given", "[m2m]") {
  const TetMesh mesh = read_mesh("kuhn:6");
  std::vector<GlobalId> ids(mesh.n_tets());
  const MeshView view{mesh.points, mesh.tets, {}, ids, 0};
  const Cover cover = cover_tets(mesh.points, mesh.tets);
  const std::vector<std::uint32_t> first{0};
  std::uint64_t n_tested = 0;
  const BestDonors best = donors_of_list(view, cover, first, mesh.points, 0, n_tested);
  CHECK(!best.points.empty());
  CHECK(best.points.size() < mesh.n_points());
  CHECK(n_tested < 100 * cover.members_of(0).size());
}

TEST_CASE("the points of several lists have the donors that those of each list have", "[m2m]") {
  const TetMesh mesh = read_mesh("kuhn:7");
  std::vector<GlobalId> ids(mesh.n_tets());
  std::iota(ids.begin(), ids.end(), 0);
  const MeshView view{mesh.points, mesh.tets, {}, ids, 0};
  constexpr double tolerance = 0.05;
  const Cover cover = cover_tets(mesh.points, mesh.tets, tolerance);
  std::vector<std::uint32_t> all(cover.boxes.size());
  std::iota(all.begin(), all.end(), 0U);
  const std::vector<Point> some = random_points(40, {0.5, 0.5, 0.5}, -0.04);
  const std::vector<Point> others = random_points(900, {1.1, 1.1, 1.1}, -0.05);
  const std::vector<std::span<const Point>> lists{some, {}, others, some, mesh.points};
  std::uint64_t n_tested = 0, n_tested_apart = 0;
  const std::vector<BestDonors> found = best_donors(view, cover, all, lists, tolerance, n_tested);
  REQUIRE(found.size() == lists.size());
  for (std::size_t l = 0; l < lists.size(); ++l) {
    std::uint64_t n = 0;
    const BestDonors apart = donors_of_list(view, cover, all, lists[l], tolerance, n);
    n_tested_apart += n;
    CHECK(found[l].points == apart.points);
    CHECK(found[l].tets == apart.tets);
    REQUIRE(found[l].donors.size() == apart.donors.size());
    for (std::size_t i = 0; i < apart.donors.size(); ++i) {
      CHECK(found[l].donors[i].weights == apart.donors[i].weights);
      CHECK(found[l].candidates[i].distance == apart.candidates[i].distance);
    }
  }
  CHECK(!found[0].points.empty());
  CHECK(found[1].points.empty());
  CHECK(found[2].points.size() < others.size());
  CHECK(n_tested == n_tested_apart);
}
