#include "m2m/kuhn.hpp"
#include "m2m/mesh/partition/partition.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "m2m/rows/search/nearest_parts.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <span>

using namespace tess::m2m;

namespace {

/// Brute force. Ties go to the lowest vertex.
NearestVertex::Answer nearest_by_force(std::span<const Point> points, const Point& p) {
  NearestVertex::Answer best{-1, INFINITY};
  for (std::size_t v = 0; v < points.size(); ++v) {
    const double squared = squared_distance(p, points[v]);
    if (squared < best.squared_distance) best = {static_cast<std::int32_t>(v), squared};
  }
  return best;
}

/// Points in and around the unit cube, many of them equally near to several lattice points, and
/// some far away.
std::vector<Point> queries() {
  std::vector<Point> points = kuhn_mesh({9}).points;
  for (Point& p : points)
    for (double& x : p) x = 3 * x - 1;
  for (const Point& p : kuhn_mesh({6}).points) points.push_back({p[0] + 1.0 / 12, p[1] * 2, p[2]});
  for (const Point& p : kuhn_mesh({5, 0.2}).points) points.push_back({p[0], p[1], p[2] + 40});
  points.push_back({1e9, 3, -1e9});
  points.push_back({0.5, 0.5, 1e100});
  return points;
}

}  // namespace

TEST_CASE("the nearest vertex is that of brute force, and ties go to the lowest",
          "[m2m][nearest]") {
  for (const double jitter : {0.0, 0.2}) {
    const TetMesh mesh = kuhn_mesh({6, jitter});
    for (const std::size_t n : {std::size_t{1}, std::size_t{17}, mesh.n_points()}) {
      const std::span points = std::span(mesh.points).first(n);
      const NearestVertex nearest(points);
      for (const Point& p : queries()) {
        const auto want = nearest_by_force(points, p);
        if (nearest.find(p).vertex != want.vertex) FAIL("not vertex " << want.vertex);
        if (nearest.find(p, want.squared_distance).vertex != want.vertex)
          FAIL("vertex " << want.vertex << " is within reach");
        if (nearest.find(p, std::nextafter(want.squared_distance, -1)).vertex != -1)
          FAIL("vertex " << want.vertex << " is beyond reach");
      }
    }
  }
  CHECK(NearestVertex({}).find({0, 0, 0}).vertex == -1);
}

TEST_CASE("the nearest vertices are those of brute force, in the order of (distance, id)",
          "[m2m][nearest]") {
  const TetMesh mesh = kuhn_mesh({4});  // a lattice: many are equally near
  const NearestVertex nearest(mesh.points);
  std::vector<NearestVertex::Neighbour> all, found;
  for (const Point& p : queries()) {
    all.clear();
    for (std::size_t v = 0; v < mesh.n_points(); ++v)
      all.push_back({squared_distance(p, mesh.points[v]), static_cast<GlobalId>(v),
                     static_cast<std::int32_t>(v)});
    std::sort(all.begin(), all.end());
    for (const std::size_t n : {std::size_t{1}, std::size_t{12}, all.size() + 5}) {
      nearest.find(p, n, INFINITY, found);
      const std::size_t n_found = std::min(n, all.size());
      if (!std::ranges::equal(found, std::span(all).first(n_found))) FAIL("not the nearest " << n);
      nearest.find(p, n, std::nextafter(all[0].squared_distance, -1), found);
      if (!found.empty()) FAIL("beyond reach");
      nearest.find(p, n, all[0].squared_distance, found);
      if (found.empty() || found.back().squared_distance != all[0].squared_distance)
        FAIL("within reach");
    }
  }
}

TEST_CASE("of equally near vertices the lowest id is found, whatever their order",
          "[m2m][nearest]") {
  const TetMesh mesh = kuhn_mesh({6});
  const auto n = static_cast<GlobalId>(mesh.n_points());
  std::vector<Point> reversed(mesh.points.rbegin(), mesh.points.rend());
  std::vector<GlobalId> ids;
  for (GlobalId v = 0; v < n; ++v) ids.push_back(n - 1 - v);
  const NearestVertex nearest(reversed, ids);
  for (const Point& p : queries())
    if (ids[static_cast<std::size_t>(nearest.find(p).vertex)] !=
        nearest_by_force(mesh.points, p).vertex)
      FAIL("not vertex " << nearest_by_force(mesh.points, p).vertex);
}

TEST_CASE("the search over parts gives the vertex of the whole mesh, with few parts per point",
          "[m2m][nearest]") {
  const TetMesh mesh = kuhn_mesh({12});
  const std::vector<Point> points = queries();
  for (const std::int32_t n_parts : {1, 8, 64, 300}) {
    const auto parts = split(mesh, partition(mesh, n_parts, PartitionMethod::rcb), n_parts);
    std::vector<Aabb> boxes;
    std::vector<NearestVertex> trees;
    for (const MeshPart& part : parts) {
      const auto own = std::span(part.points).first(static_cast<std::size_t>(part.n_owned));
      boxes.push_back(tess::collide::box_around(own));
      trees.emplace_back(own);
    }
    const NearestParts order(boxes, tess::collide::box_around(points));
    std::size_t n_queries = 0;
    for (const Point& p : points) {
      double reach = INFINITY;
      GlobalId best = -1;
      for (auto part = order.next(p, {}); part.squared_distance <= reach && part != order.none;
           part = order.next(p, part)) {
        ++n_queries;
        const auto found = trees[static_cast<std::size_t>(part.number)].find(p, reach);
        if (found.vertex < 0) continue;
        const GlobalId vertex = parts[static_cast<std::size_t>(part.number)]
                                    .point_ids[static_cast<std::size_t>(found.vertex)];
        if (found.squared_distance < reach || best < 0 || vertex < best) best = vertex;
        reach = found.squared_distance;
      }
      const auto want = nearest_by_force(mesh.points, p).vertex;
      if (best != want) FAIL("vertex " << best << ", not " << want << ", of " << n_parts);
    }
    CAPTURE(n_parts, n_queries, points.size());
    CHECK(n_queries < 2 * points.size());
  }
}
