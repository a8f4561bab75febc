#include "m2m/overset/rim.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace tess::m2m {
namespace {

using Edge = std::pair<VertexId, VertexId>;

/// The directed edges that lack an opposite one, turned around, sorted.
std::vector<Edge> rim_edges(std::span<const std::array<VertexId, 3>> triangles) {
  std::vector<std::pair<Edge, int>> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId a = t[i], b = t[(i + 1) % 3];
      edges.push_back({std::minmax(a, b), a < b ? 1 : -1});
    }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> rim;
  for (std::size_t i = 0; i < edges.size();) {
    const Edge edge = edges[i].first;
    int sum = 0;
    for (; i < edges.size() && edges[i].first == edge; ++i) sum += edges[i].second;
    const Edge turned = sum > 0 ? Edge{edge.second, edge.first} : edge;
    rim.insert(rim.end(), static_cast<std::size_t>(std::abs(sum)), turned);
  }
  std::sort(rim.begin(), rim.end());
  return rim;
}

/// Cuts the edges, of which as many begin as end at each vertex, into loops that visit no vertex
/// twice.
std::vector<std::vector<VertexId>> loops_of(const std::vector<Edge>& rim) {
  std::map<VertexId, std::vector<VertexId>> next;
  for (auto edge = rim.rbegin(); edge != rim.rend(); ++edge)
    next[edge->first].push_back(edge->second);
  std::vector<std::vector<VertexId>> loops;
  for (auto& [start, ends] : next)
    while (!ends.empty()) {
      std::vector<VertexId> path{start};
      std::map<VertexId, std::size_t> at{{start, 0}};
      do {
        std::vector<VertexId>& open = next.at(path.back());
        const VertexId to = open.back();
        open.pop_back();
        const auto [seen, is_new] = at.emplace(to, path.size());
        if (is_new) {
          path.push_back(to);
          continue;
        }
        const auto begin = path.begin() + static_cast<std::ptrdiff_t>(seen->second);
        loops.emplace_back(begin, path.end());
        for (auto v = begin + 1; v != path.end(); ++v) at.erase(*v);
        path.erase(begin + 1, path.end());
      } while (path.size() > 1);
    }
  return loops;
}

Point at(std::span<const Point> points, VertexId v) {
  return points[static_cast<std::size_t>(v)];
}

double area_of(std::span<const Point> points, const std::array<VertexId, 3>& t) {
  const Point a = at(points, t[0]), b = at(points, t[1]), c = at(points, t[2]);
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
    const double n = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    squared += n * n;
  }
  return 0.5 * std::sqrt(squared);
}

/// The planes in which edges of a loop lie.
struct Sides {
  std::vector<SymmetryPlane> planes;
  VertexId leaves_at = -1;  // begins an edge in no plane
};
Sides sides_of(std::span<const Point> points, std::span<const VertexId> loop,
               std::span<const SymmetryPlane> symmetry) {
  Sides out;
  std::vector<bool> is_used(symmetry.size());
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point a = at(points, loop[i]), b = at(points, loop[(i + 1) % loop.size()]);
    bool is_in_plane = false;
    for (std::size_t k = 0; k < symmetry.size(); ++k) {
      if (!symmetry[k].holds(a) || !symmetry[k].holds(b)) continue;
      is_used[k] = is_in_plane = true;
    }
    if (!is_in_plane) out.leaves_at = loop[i];
  }
  for (std::size_t k = 0; k < symmetry.size(); ++k)
    if (is_used[k]) out.planes.push_back(symmetry[k]);
  return out;
}

/// A point `by` or more beyond all planes, from `start`. None if there is no direction that leads
/// away from all of them.
std::optional<Point> point_beyond(Point start, double by, std::span<const SymmetryPlane> planes) {
  constexpr double least = 0.01;  // sine of the angle to a plane
  constexpr int most_tries = 1000;
  Point way{};
  for (const SymmetryPlane& plane : planes) way = difference(way, plane.normal);
  // Turns away from the plane that the way leads to most (a perceptron), until it leads to none.
  for (int k = 0; k < most_tries; ++k) {
    const auto slope = [&](const SymmetryPlane& plane) { return dot(plane.normal, way); };
    const auto worst = std::max_element(
        planes.begin(), planes.end(),
        [&](const SymmetryPlane& a, const SymmetryPlane& b) { return slope(a) < slope(b); });
    if (slope(*worst) > -least * collide::length(way)) {
      way = difference(way, worst->normal);
      continue;
    }
    double times = 0;
    for (const SymmetryPlane& plane : planes)
      times = std::max(times, (plane.height(start) + by) / -slope(plane));
    for (std::size_t axis = 0; axis < 3; ++axis) start[axis] += times * way[axis];
    return start;
  }
  return std::nullopt;
}

}  // namespace

std::optional<SameDirection> same_direction(std::span<const std::array<VertexId, 3>> triangles) {
  std::map<Edge, std::vector<std::pair<std::size_t, bool>>> edges;  // a triangle, and its direction
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      edges[std::minmax(a, b)].emplace_back(t, a < b);
    }
  std::optional<SameDirection> found;
  for (const auto& [edge, sides] : edges) {
    if (sides.size() > 2) return std::nullopt;
    if (!found && sides.size() == 2 && sides[0].second == sides[1].second)
      found = {{sides[0].first, sides[1].first}, edge};
  }
  return found;
}

Rim close(std::vector<Point>& points, std::vector<std::array<VertexId, 3>>& triangles,
          std::span<const SymmetryPlane> symmetry) {
  const auto loops = loops_of(rim_edges(triangles));
  Rim rim;
  double wall = 0, caps = 0;
  for (const auto& t : triangles) wall += area_of(points, t);
  for (const auto& loop : loops) {
    const Sides sides = sides_of(points, loop, symmetry);
    const bool is_on_symmetry = !sides.planes.empty() && sides.leaves_at < 0;
    if (!sides.planes.empty() && sides.leaves_at >= 0) rim.leaves_at = sides.leaves_at;
    if (is_on_symmetry)
      for (const VertexId v : loop)
        project({&points[static_cast<std::size_t>(v)], 1}, sides.planes);
    Point centroid{};
    for (const VertexId v : loop)
      for (std::size_t k = 0; k < 3; ++k)
        centroid[k] += at(points, v)[k] / static_cast<double>(loop.size());
    const auto centre = static_cast<VertexId>(points.size());
    if (is_on_symmetry) {
      double width = 0;
      for (const VertexId v : loop)
        width = std::max(width, collide::length(difference(at(points, v), centroid)));
      const auto apex = point_beyond(centroid, width, sides.planes);
      if (!apex) rim.between = loop[0];
      centroid = apex.value_or(centroid);
      ++rim.n_on_symmetry;
    } else {
      ++rim.n_loops;
      rim.n_edges += loop.size();
    }
    points.push_back(centroid);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      triangles.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
      if (!is_on_symmetry) caps += area_of(points, triangles.back());
    }
  }
  rim.cap_share = caps > 0 ? caps / (wall + caps) : 0;
  return rim;
}

std::vector<std::size_t> rim_edges_in(std::span<const Point> points,
                                      std::span<const std::array<VertexId, 3>> triangles,
                                      std::span<const SymmetryPlane> planes) {
  std::vector<std::size_t> n(planes.size());
  for (const auto& [a, b] : rim_edges(triangles))
    for (std::size_t k = 0; k < planes.size(); ++k)
      if (planes[k].holds(at(points, a)) && planes[k].holds(at(points, b))) ++n[k];
  return n;
}

}  // namespace tess::m2m
