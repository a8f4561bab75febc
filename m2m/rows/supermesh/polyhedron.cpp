#include "m2m/rows/supermesh/polyhedron.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

/// The point of the edge from `in` (above the face) to `out` (below) at the height zero. Swapping
/// both ends and all signs gives the same bits, so the two tetrahedra at a face cut alike (unless
/// only one of them is flat, moments.cpp).
Polyhedron::Vertex crossing(const Polyhedron::Vertex& in, const Polyhedron::Vertex& out,
                            std::size_t face) {
  const double a = in.heights[face], b = out.heights[face];
  const double to_out = a / (a - b), to_in = -b / (a - b);
  Polyhedron::Vertex vertex{};
  for (std::size_t k = 0; k < 4; ++k) {
    vertex.weights[k] = to_out * out.weights[k] + to_in * in.weights[k];
    vertex.heights[k] = to_out * out.heights[k] + to_in * in.heights[k];
  }
  vertex.heights[face] = 0;
  return vertex;
}

}  // namespace

Polyhedron::Polyhedron(const std::array<Weights, 4>& heights) {
  constexpr std::array<std::array<std::uint8_t, 3>, 4> next{
      {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {1, 0, 2}}};
  for (std::size_t v = 0; v < 4; ++v) {
    vertices_[v] = {{}, heights[v], next[v]};
    vertices_[v].weights[v] = 1;
  }
}

bool Polyhedron::cut() {
  for (std::size_t face = 0; face < 4; ++face)
    if (!cut(face)) return false;
  return true;
}

bool Polyhedron::cut(std::size_t face) {
  double low = vertices_[0].heights[face], high = low;
  for (std::size_t v = 1; v < n_; ++v) {
    low = std::min(low, vertices_[v].heights[face]);
    high = std::max(high, vertices_[v].heights[face]);
  }
  if (!(high > 0)) return false;
  if (low >= 0) return true;
  const auto below = [&](std::size_t v) { return vertices_[v].heights[face] < 0; };
  const std::size_t n_old = n_;
  for (std::size_t v = 0; v < n_old; ++v) {
    if (below(v)) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      const std::uint8_t other = vertices_[v].next[side];
      if (!below(other)) continue;
      vertices_[n_] = crossing(vertices_[v], vertices_[other], face);
      vertices_[n_].next[0] = static_cast<std::uint8_t>(v);
      vertices_[v].next[side] = static_cast<std::uint8_t>(n_++);
    }
  }
  // Links the new vertices: from each one around the face to the next one.
  for (std::size_t start = n_old; start < n_; ++start) {
    std::size_t previous = start, at = vertices_[start].next[0];
    while (at < n_old) {
      std::size_t side = 0;
      while (vertices_[at].next[side] != previous) ++side;
      previous = at;
      at = vertices_[at].next[(side + 1) % 3];
    }
    vertices_[start].next[2] = static_cast<std::uint8_t>(at);
    vertices_[at].next[1] = static_cast<std::uint8_t>(start);
  }
  // Closes the gaps that the removed vertices leave.
  std::array<std::uint8_t, capacity> place{};
  std::size_t n_kept = 0;
  for (std::size_t v = 0; v < n_; ++v) {
    if (v < n_old && below(v)) continue;
    place[v] = static_cast<std::uint8_t>(n_kept);
    if (n_kept != v) vertices_[n_kept] = vertices_[v];
    ++n_kept;
  }
  n_ = n_kept;
  for (std::size_t v = 0; v < n_; ++v)
    for (std::uint8_t& next : vertices_[v].next) next = place[next];
  return true;
}

}  // namespace tess::m2m
