// The part of a tetrahedron that lies in another one: a convex polyhedron, cut by one half-space
// after the other. It is a graph in which every vertex has three neighbours, in counter-clockwise
// order seen from outside. A cut removes vertices, and closes the open edges in a ring:
//
//        /|\                 Vertices below the plane go. Each edge that crosses the plane gets a
//     --+-+-+-- plane        new vertex; the new vertices are linked by a walk around the faces.
//      /  |  \               A degenerate case (a vertex, an edge or a face in the plane) only gives
//                            vertices that coincide, and pieces without volume.
//
// (Powell and Abel 2015, "An exact general remeshing scheme applied to physically conservative
// voxelization", section 3.) Unlike there, vertices have barycentric coordinates, those of the
// carried tetrahedron, and heights above the four faces of the cutting one. So no result depends on
// the place or the unit of the coordinates, and all corners have coordinates without an error.
#pragma once

#include "m2m/mesh.hpp"
#include "m2m/rows/interpolate/locate.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tess::m2m {

using Corners = std::array<Point, 4>;

class Polyhedron {
 public:
  struct Vertex {
    Weights weights;  ///< barycentric coordinates in the carried tetrahedron
    Weights heights;  ///< above the faces of the cutting tetrahedron; their sum is constant
    std::array<std::uint8_t, 3> next;
  };

  /// The whole carried tetrahedron. `heights[v]`: of its corner v above the four faces.
  explicit Polyhedron(const std::array<Weights, 4>& heights);

  /// Removes what lies below the faces. Returns false if no volume is left.
  [[nodiscard]] bool cut();

  /// Calls visit(fraction, a, b, c, d) for tetrahedra that make up the polyhedron. `fraction`: the
  /// volume of the piece as a fraction of the carried tetrahedron; pieces that have none, up to
  /// rounding, are left out. a to d: its corners, of type Vertex.
  template <class Visit>
  void for_each_piece(Visit&& visit) const;

 private:
  [[nodiscard]] bool cut(std::size_t face);

  static constexpr std::size_t capacity = 32;  // at most 12 are left after a cut
  std::array<Vertex, capacity> vertices_;
  std::size_t n_ = 4;
};

template <class Visit>
void Polyhedron::for_each_piece(Visit&& visit) const {
  const Weights& apex = vertices_[0].weights;
  // Three of the four coordinates are enough for volumes.
  const auto edge = [&](std::size_t v) {
    const Weights& w = vertices_[v].weights;
    return Point{w[1] - apex[1], w[2] - apex[2], w[3] - apex[3]};
  };
  std::array<std::array<bool, 3>, capacity> seen{};
  for (std::size_t first = 0; first < n_; ++first) {
    for (std::size_t start = 0; start < 3; ++start) {
      if (seen[first][start]) continue;
      // Walks around the face on the left of this edge, as a fan of triangles from `first`.
      std::size_t previous = first, side = start, at = vertices_[first].next[start];
      seen[first][start] = true;
      bool holds_apex = first == 0 || at == 0;
      std::array<std::size_t, capacity> ring{first, at};
      std::size_t n_ring = 2;
      for (;;) {
        side = 0;
        while (vertices_[at].next[side] != previous) ++side;
        side = (side + 1) % 3;
        seen[at][side] = true;
        previous = at;
        at = vertices_[at].next[side];
        if (at == first) break;
        holds_apex = holds_apex || at == 0;
        ring[n_ring++] = at;
      }
      if (holds_apex) continue;  // no volume between the apex and this face
      const Point a = edge(first);
      for (std::size_t k = 1; k + 1 < n_ring; ++k) {
        const Point b = edge(ring[k]), c = edge(ring[k + 1]);
        const double fraction = dot(a, cross(b, c));
        if (fraction > 0)
          visit(fraction, vertices_[0], vertices_[first], vertices_[ring[k]],
                vertices_[ring[k + 1]]);
      }
    }
  }
}

}  // namespace tess::m2m
