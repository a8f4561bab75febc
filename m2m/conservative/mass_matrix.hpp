// The consistent mass matrix of linear elements on one part of a mesh, element by element:
//
//     M_ij = sum over tetrahedra T of integral over T of psi_i psi_j,
//     integral over T of psi_i psi_j = |T| (1 + delta_ij) / 20 .
//
// A tetrahedron that the source covers in part contributes the integral over its covered region,
// and one that is not covered contributes nothing. Where less than half is covered, only the row sums
// of that integral are used: values at the corners would otherwise extrapolate from a sliver. This
// keeps constants and integrals, and no vertex gets a value far outside those of the source. Every
// tetrahedron is in one part; the caller adds the contributions of parts over the copies of a vertex.
#pragma once

#include "m2m/conservative/loads.hpp"

#include <span>
#include <vector>

namespace tess::m2m {

class MassMatrix {
 public:
  /// Refers to the tetrahedra of `mesh`, which must outlive it. `coverage`: per tetrahedron, added
  /// over all source parts; empty if the source covers the mesh. `mesh.tets`: those of this part.
  explicit MassMatrix(MeshView mesh, std::span<const CellCoverage> coverage = {});

  [[nodiscard]] std::size_t n_points() const noexcept { return n_points_; }

  /// y += M x, of this part. Both: n_points × n_components, row-major.
  void multiply_add(std::span<const double> x, std::size_t n_components, std::span<double> y) const;
  /// Adds the diagonal of M to `diagonal`, and its row sums (the lumped masses) to `lumped`.
  void add_diagonals(std::span<double> diagonal, std::span<double> lumped) const;

  /// Calls visit(tet, element) for every tetrahedron that has a covered volume; `element` is its
  /// Matrix4.
  template <class Visit>
  void for_each_element(Visit&& visit) const {
    for (std::size_t t = 0; t < tets_.size(); ++t)
      if (partial_[t] != none) visit(tets_[t], element(t));
  }

 private:
  static constexpr std::int32_t whole = -1;
  static constexpr std::int32_t none = -2;
  [[nodiscard]] Matrix4 element(std::size_t tet) const;

  std::span<const Tet> tets_;
  std::size_t n_points_;
  std::vector<double> twentieths_;     // |T| / 20, per tetrahedron
  std::vector<std::int32_t> partial_;  // per tetrahedron: whole, none, or a position in cut_
  std::vector<Symmetric4> cut_;
};

/// The covered fraction of each vertex: the integral of its basis function over the covered region,
/// relative to the integral over the whole mesh. Both are added over the copies by the caller:
/// `covered` from add_diagonals() with coverage, `whole` from add_diagonals() without.
[[nodiscard]] std::vector<double> covered_fractions(std::span<const double> covered,
                                                    std::span<const double> whole);

}  // namespace tess::m2m
