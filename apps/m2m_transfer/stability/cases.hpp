// The cases of the stability report: extreme meshes and points, with what is known of the result.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace m2m_transfer::stability {

struct Case {
  std::string name;
  std::string parameter{};  ///< the quantity that is varied, as "offset"; may be empty
  double value = 0;         ///< of the parameter
  TetMesh source{}, target{};
  std::vector<double> values{};  ///< at the source vertices
  /// At the target vertices, NaN where it is not known; empty: the values name the donors.
  std::vector<double> truth{};
  double tolerance = 0;  ///< of |value - truth| at the vertices found
  /// Vertices outside, if it is known.
  std::optional<std::size_t> outside = 0;
  bool may_be_refused = false;  ///< beyond the limits of m2m/README.md
  /// The target of this case in another order: the same bits as the case before, whose vertex
  /// order[k] is vertex k here.
  std::vector<std::size_t> order{};
};

/// Generated meshes; `n_points`: how many points on faces and edges.
[[nodiscard]] std::vector<Case> generated_cases(std::size_t n_points);
/// The user's own mesh: onto itself, far away, scaled, permuted, points on its faces and edges.
[[nodiscard]] std::vector<Case> cases_of(const TetMesh& mesh, std::size_t n_points);
/// One of the user's meshes onto another.
[[nodiscard]] Case case_between(const TetMesh& source, const TetMesh& target);

// The meshes and points of these cases. Random choices are the same in every run.

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
/// Draws n random points, in turn on faces (thirds, halves and random places) and edges.
[[nodiscard]] std::vector<Point> on_faces_and_edges(const TetMesh& mesh, std::size_t n);

/// True if the tetrahedron holds the point in extended precision, with barycentric coordinates of
/// at least `least`.
[[nodiscard]] bool holds(const TetMesh& mesh, std::size_t tet, const Point& point, double least);

}  // namespace m2m_transfer::stability
