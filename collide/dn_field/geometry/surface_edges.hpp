// The edges of a mesh and how its triangles use them, from which holes, flipped triangles and
// closed parts are found. Linear in the number of triangles.
#pragma once

#include "collide/dn_field/surface.hpp"

#include <algorithm>

namespace tess::dn {

/// An edge, and the number of triangles that run along it from the lower to the upper vertex and
/// back.
struct EdgeUse {
  std::uint32_t low = 0, high = 0;
  int up = 0, down = 0;
};

/// Calls visit(EdgeUse) for every edge of `surface`, by ascending vertices. Edges from a vertex to
/// itself are left out.
template <class Visit>
void each_edge(const Surface& surface, const Visit& visit) {
  // A counting sort by the lower vertex, then a sort of each vertex's few edges by the upper one.
  const auto each_side = [&](const auto& see) {
    for (const auto& t : surface.triangles)
      for (std::size_t i = 0; i < 3; ++i)
        if (t[i] != t[(i + 1) % 3]) see(t[i], t[(i + 1) % 3]);
  };
  std::vector<std::size_t> begin(surface.vertices.size() + 2, 0);
  each_side([&](std::uint32_t a, std::uint32_t b) { ++begin[std::min(a, b) + std::size_t{2}]; });
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  struct Upper {
    std::uint32_t vertex;
    bool goes_up;
  };
  std::vector<Upper> upper(begin.back());
  each_side([&](std::uint32_t a, std::uint32_t b) {
    upper[begin[std::min(a, b) + std::size_t{1}]++] = {std::max(a, b), a < b};
  });
  for (std::uint32_t low = 0; low < surface.vertices.size(); ++low) {
    const auto first = upper.begin() + static_cast<std::ptrdiff_t>(begin[low]);
    const auto last = upper.begin() + static_cast<std::ptrdiff_t>(begin[low + std::size_t{1}]);
    std::sort(first, last, [](Upper a, Upper b) { return a.vertex < b.vertex; });
    for (auto at = first; at != last;) {
      EdgeUse edge{low, at->vertex};
      for (; at != last && at->vertex == edge.high; ++at) ++(at->goes_up ? edge.up : edge.down);
      visit(edge);
    }
  }
}

}  // namespace tess::dn
