// The mass matrix of linear elements on the covered region C of a part of the target mesh, element
// by element. For a tetrahedron T inside C it is the consistent one,
//
//     M_ab = integral over T of psi_a psi_b = |T| (1 + delta_ab) / 20 .
//
// For one that the source covers in part, only the integrals c_a of psi_a over C ∩ T are known: the
// loads of the constant 1. They become the row sums of
//
//     M_ab = e (1 + delta_ab) + delta_ab (c_a - 5 e),   e = min c_a / 5 <= |T| / 20,
//
// the consistent matrix scaled, and the rest on the diagonal. So constants and integrals are kept,
// a sliver gives no vertex a value far from those of the source, and the eigenvalues relative to
// the diagonal lie in [1/2, 5/2] for every mesh and every coverage (Wathen 1987): projection.hpp
// needs no other property. Of triangles it is |T| (1 + delta_ab) / 12, with 4 e for 5 e, and the
// eigenvalues lie in [1/2, 2].
#pragma once

#include "m2m/mesh_view.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// The tetrahedra of a part that touch a point it owns, in ascending order of ids: the order of all
/// sums, so that they do not depend on the partition.
[[nodiscard]] std::vector<std::int32_t> tets_at_owned(const MeshView& mesh);

/// The volume of a tetrahedron, exactly 0 if there is none, or the area of a triangle.
[[nodiscard]] double size_of(const MeshView& mesh, const Tet& cell);

class MassMatrix {
 public:
  MassMatrix() = default;
  /// `numbers`: tets_at_owned(). `covered`: the loads of the constant 1 per number and corner.
  MassMatrix(const MeshView& mesh, std::span<const std::int32_t> numbers,
             std::span<const std::array<double, 4>> covered);

  [[nodiscard]] std::size_t n_points() const noexcept { return n_points_; }
  [[nodiscard]] std::size_t n_owned() const noexcept { return lumped_.size(); }
  /// Per point owned: the row sum of M, zero if the point is not covered.
  [[nodiscard]] std::span<const double> lumped() const noexcept { return lumped_; }
  /// Per point owned: the row sum of M relative to that of a mesh that is covered; above 1 where the
  /// source overlaps itself.
  [[nodiscard]] std::span<const double> covered_fractions() const noexcept { return fractions_; }
  /// Per point owned: 1 / M_ii, zero if the point is not covered.
  [[nodiscard]] std::span<const double> inverse_diagonal() const noexcept { return inverse_; }

  /// y = M x at the points owned; x is given at all points.
  void multiply(std::span<const double> x, std::size_t n_components, std::span<double> y) const;

  /// A tetrahedron has 4; of a triangle's the first 3 count.
  [[nodiscard]] std::size_t n_corners() const noexcept { return n_corners_; }
  /// Calls visit(corners, e) for every tetrahedron that is covered.
  template <class Visit>
  void for_each_element(const Visit& visit) const {
    for (std::size_t t = 0; t < tets_.size(); ++t)
      if (off_diagonal_[t] > 0) visit(tets_[t], off_diagonal_[t]);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_points_, n_corners_, tets_, off_diagonal_, rest_, lumped_, fractions_, inverse_);
  }

 private:
  std::size_t n_points_ = 0, n_corners_ = 4;
  std::vector<Tet> tets_;
  std::vector<double> off_diagonal_;  // e, per tetrahedron
  std::vector<double> rest_;          // per point owned: the sum of c_a - 5 e
  std::vector<double> lumped_, fractions_, inverse_;
};

}  // namespace tess::m2m
