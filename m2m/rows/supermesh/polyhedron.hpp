// The part of a tetrahedron that lies in another one: a convex polyhedron, cut by one half-space
// after the other. Each vertex is where three planes meet, each edge where two do, of the four faces
// of the carried tetrahedron and the four of the cutting one. So a list of vertices per plane, as
// bits, is the whole graph: the ends of an edge are the vertices that two planes share.
//
//        /|\                 Vertices that are not above the plane go. Each edge that crosses the
//     --+-+-+-- plane        plane gets a new vertex on its two planes and on this one.
//      /  |  \               A degenerate case (a vertex, an edge or a face in the plane) only gives
//                            vertices that coincide, and pieces without volume.
//
// (The cuts are those of Powell and Abel 2015, "An exact general remeshing scheme applied to
// physically conservative voxelization", section 3, without the walks around faces.) Vertices have
// barycentric coordinates, those of the carried tetrahedron, and heights above the four faces of the
// cutting one. So no result depends on the place or the unit of the coordinates, and all corners
// have coordinates without an error.
#pragma once

#include "m2m/rows/supermesh/tet_planes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tess::m2m {

class Polyhedron {
 public:
  /// Four weights in the carried tetrahedron, then four heights above the faces of the cutting one.
  using Vertex = simd::Vector<double, 8>;

  /// The whole carried tetrahedron; the heights are those of its corners.
  explicit Polyhedron(const Heights& heights);

  /// Removes what does not lie above a face. Returns false if nothing is left.
  template <std::size_t face>
  [[nodiscard]] bool cut();

  /// Replaces heights by weights in the cutting tetrahedron. No height is negative but by rounding,
  /// so the four add up without cancellation. (At corners of the carried tetrahedron, far outside
  /// of a flat cutting one, they do not.)
  void heights_to_weights();

  struct Integrals {
    double volume = 0;              ///< as a fraction of the carried tetrahedron
    std::array<Vertex, 2> mixed{};  ///< 20 times those of weight a times height c, at 4 a + c
  };
  [[nodiscard]] Integrals integrals() const;

 private:
  /// Bits of vertices, per plane.
  using Planes = simd::Vector<std::uint32_t, 8>;

  static constexpr std::size_t capacity = 32;  // at most 4 + 4 + 5 + 6 + 7 vertices are ever made
  std::array<Vertex, capacity> vertices_;
  std::uint32_t n_ = 4;
  std::uint32_t left_ = 0xF;                // those that no cut has removed
  Planes on_;                               // of those left: carried faces, then cutting ones
  simd::Vector<std::uint32_t, 4> above_{};  // per cutting face
};

}  // namespace tess::m2m
