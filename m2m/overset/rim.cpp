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

double area_of(std::span<const Point> points, const std::array<VertexId, 3>& t) {
  const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(t[i])]; };
  const Point a = at(0), b = at(1), c = at(2);
  double squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
    const double n = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    squared += n * n;
  }
  return 0.5 * std::sqrt(squared);
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
    if (sides.size() != 2) return std::nullopt;
    if (!found && sides[0].second == sides[1].second)
      found = {{sides[0].first, sides[1].first}, edge};
  }
  return found;
}

Rim close(std::vector<Point>& points, std::vector<std::array<VertexId, 3>>& triangles) {
  const std::vector<Edge> edges = rim_edges(triangles);
  const auto loops = loops_of(edges);
  double wall = 0, caps = 0;
  for (const auto& t : triangles) wall += area_of(points, t);
  for (const auto& loop : loops) {
    Point centroid{};
    for (const VertexId v : loop)
      for (std::size_t k = 0; k < 3; ++k)
        centroid[k] += points[static_cast<std::size_t>(v)][k] / static_cast<double>(loop.size());
    const auto centre = static_cast<VertexId>(points.size());
    points.push_back(centroid);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      triangles.push_back({loop[i], loop[(i + 1) % loop.size()], centre});
      caps += area_of(points, triangles.back());
    }
  }
  return {edges.size(), loops.size(), caps > 0 ? caps / (wall + caps) : 0};
}

}  // namespace tess::m2m
