// The cases of the stability report: extreme meshes and points, with what is known of the result.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"

#include <cstddef>
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

}  // namespace m2m_transfer::stability
