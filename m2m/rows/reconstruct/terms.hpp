// Least squares for fits of polynomials to neighbours, whose columns may depend on each other.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tess::m2m {

[[nodiscard]] double dot(std::span<const double> a, std::span<const double> b);

/// One-sided Jacobi (Hestenes 1958): rotates the three columns of `a` until they are orthogonal,
/// and the columns of `v` with them. Small singular values are as accurate as large ones.
void orthogonalise(std::array<std::span<double>, 3> a, std::array<Point, 3>& v);

/// The columns of a system, orthonormalised one by one (Gram-Schmidt, twice): Q and the triangular
/// R. A column that depends on those before it is left out: the order of the columns says which
/// terms of a polynomial matter more. (Pivoting would drop any, such as the constant.)
class Terms {
 public:
  /// A quadratic polynomial in three variables has so many terms.
  static constexpr std::size_t most = 10;
  using Numbers = std::array<double, most>;

  /// `q` takes the columns of Q, of `n` numbers each. A column is left out unless a part of more
  /// than `least_independent` of it is independent of those before it.
  Terms(std::vector<double>& q, std::size_t n, double least_independent)
      : q_(q), n_(n), least_independent_(least_independent) {
    q_.clear();
  }

  [[nodiscard]] std::size_t size() const { return n_terms_; }
  /// Returns the part of the column that is independent of those before it; 0: it is left out.
  double append(std::span<double> column);
  /// The y with Rᵀ y = `to`: the weights of the fit's value are Q y, if `to` are its terms there.
  [[nodiscard]] Numbers solve(const Numbers& to) const;

 private:
  std::vector<double>& q_;
  std::size_t n_;
  double least_independent_;
  std::size_t n_terms_ = 0;
  std::array<Numbers, most> r_{};  // by columns
};

}  // namespace tess::m2m
