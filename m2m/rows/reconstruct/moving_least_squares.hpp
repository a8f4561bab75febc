// The weights of moving least squares: the value at a point of the polynomial that fits the values
// of its nearest neighbours best, where near ones count more (Lancaster and Salkauskas 1981):
//
//     sum of φ(|x_j - x| / r) (p(x_j) - u_j)² is least,  φ(s) = (1 - s)⁴ (4 s + 1)  (Wendland 1995)
//
// with r slightly more than the distance of the farthest neighbour. The fit is done in principal
// axes around the weighted centroid of the neighbours, each in its own unit. Polynomials of the
// order are exact.
//
// Neighbours that do not determine the polynomial fall back. A direction without extent (all in one
// plane, on one line, in one place), or with so little that the point lies far beyond it, is left
// out: the value is that at the foot of the point. Then the order is lower, down to the weighted
// mean, until the weights amplify no value much.
#pragma once

#include "m2m/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

class MovingLeastSquares {
 public:
  /// `order`: of the polynomials, 1 or 2.
  explicit MovingLeastSquares(std::int32_t order) : order_(order) {}

  /// How many neighbours a point needs: twelve for the four terms of a linear polynomial, thirty
  /// for the ten of a quadratic one.
  [[nodiscard]] static constexpr std::size_t n_neighbours(std::int32_t order) {
    return order == 1 ? 12 : 30;
  }

  /// What the polynomial of a fit is.
  struct Fit {
    std::int32_t order = 0;      ///< 0: the weighted mean
    std::int32_t dimension = 3;  ///< in so many directions
    friend bool operator==(const Fit&, const Fit&) = default;
  };
  /// Computes the weights of the neighbours for the value at a point; at least one neighbour. The
  /// bits depend on the order of the neighbours.
  Fit compute(const Point& at, std::span<const Point> neighbours);

  /// Per neighbour of the last compute(). Their sum is 1.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

 private:
  void set_axes(const Point& at, std::span<const Point> neighbours);
  /// Sets columns_ to the terms of the neighbours, weighted, one after the other.
  void set_columns(std::int32_t order, std::size_t n_axes);
  /// False, unless the neighbours determine this polynomial and its weights are small.
  [[nodiscard]] bool fits(std::int32_t order, std::size_t n_axes);
  /// True if the neighbours' coordinate on an axis follows from those on the wider axes.
  [[nodiscard]] bool follows(std::size_t axis);

  std::int32_t order_;
  std::vector<double> importance_;  // the square root of φ, per neighbour
  std::vector<Point> local_;        // the neighbours in principal axes, the widest first
  Point local_at_{};                // the point there
  std::array<double, 3> extent_{};  // of the axes, in units of r; descending
  std::size_t n_axes_ = 0;          // that can be used
  std::vector<double> weights_, columns_, q_;
};

}  // namespace tess::m2m
