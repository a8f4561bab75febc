// Meshes and points of the stability report. Random choices are the same in every run.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "m2m/mesh.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace m2m_transfer::stability {

/// Every point is mapped.
[[nodiscard]] TetMesh mapped(TetMesh mesh, const std::function<Point(const Point&)>& map);
/// Every coordinate is multiplied by `scale`, then moved by `offset`.
[[nodiscard]] TetMesh changed(TetMesh mesh, double scale, double offset);

/// Every tetrahedron becomes four, with a new vertex at this part of its height above a face: one
/// of the four is a sliver.
[[nodiscard]] TetMesh with_slivers(const TetMesh& mesh, double height);

/// The mesh kuhn:n with a flat tetrahedron on every square of its lower side, listed before the
/// others.
[[nodiscard]] TetMesh with_flat_side(int n);
/// Turned about two axes, so that no side of a box is aligned with an axis; rounded.
[[nodiscard]] Point turned(const Point& p);

/// A coarse box beside a fine one: the vertices of the fine one lie on faces and edges of the
/// coarse one.
[[nodiscard]] TetMesh coarse_beside_fine();

/// A random order of n things: the k-th thing of the new order was at order[k].
[[nodiscard]] std::vector<std::size_t> random_order(std::size_t n, std::uint64_t seed);
/// The mesh with the vertices in this order, and the tetrahedra in a random one.
[[nodiscard]] TetMesh permuted(const TetMesh& mesh, const std::vector<std::size_t>& order);

/// Every tetrahedron has four vertices of its own, so values can name the tetrahedron.
[[nodiscard]] TetMesh exploded(const TetMesh& mesh);

/// A mesh of at least 4 points for a target. Its tetrahedra join points that follow each other.
[[nodiscard]] TetMesh cloud(std::vector<Point> points);
/// So many random points, in turn on faces (thirds, halves and random places) and edges.
[[nodiscard]] std::vector<Point> on_faces_and_edges(const TetMesh& mesh, std::size_t n);

/// True if the tetrahedron holds the point in extended precision, with barycentric coordinates of
/// at least `least`.
[[nodiscard]] bool holds(const TetMesh& mesh, std::size_t tet, const Point& point, double least);

}  // namespace m2m_transfer::stability
