// The gradient at a point from the values of neighbours, by a least-squares fit of a quadratic
// polynomial through the value at the point itself (very near neighbours have no greater weight):
//
//     u_j - u_0 ~ g·d_j + ½ d_j·H d_j,   d_j = x_j - x_0,   weighted by 1 / |d_j|² .
//
// The gradient of the fit is second-order accurate inside and at boundaries (polynomial preserving
// recovery: Zhang and Naga 2005, "A new finite element gradient recovery method"). The fit is done
// in principal axes, each in its own unit, so neither the scale of a patch nor the aspect of its
// layers, up to 1e13, changes the result.
//
// Patches that do not determine all terms fall back, term by term: a quadratic term that depends on
// the terms before it is dropped; in a direction without extent (all neighbours in one plane or on
// one line, or nearly so, seen from what extrapolates) the gradient is zero.
#pragma once

#include "m2m/mesh.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tess::m2m {

/// The rounding of offsets from a point: a unit in the last place of its largest coordinate.
[[nodiscard]] double rounding_at(const Point& p) noexcept;

enum class FitDegree : std::uint8_t { linear, quadratic };

class GradientFit {
 public:
  /// Computes weights from the offsets d_j, in their order. Returns how well they determine the
  /// polynomial: the least part of a term that is independent of the terms before it, 0 if a term
  /// was dropped. Below `well_determined` the weights amplify what the polynomial leaves out.
  /// `rounding`: of the offsets; extents that are not clearly above it are none.
  /// `arms`: offsets of points to which the gradient extrapolates; a direction in which they reach
  /// more than four times as far as the neighbours is left out.
  double compute(std::span<const Point> offsets, FitDegree degree, double rounding,
                 std::span<const Point> arms = {});

  static constexpr double well_determined = 0.4;

  /// Per neighbour: gradient = sum of weights[j] (u_j - u_0).
  [[nodiscard]] std::span<const Point> weights() const noexcept { return weights_; }

 private:
  std::size_t principal_axes(std::span<const Point> offsets, double rounding,
                             std::span<const Point> arms);

  std::vector<Point> weights_;
  std::vector<double> axes_;    // coordinates in principal axes: 3 columns
  std::array<Point, 3> basis_;  // the gradient per unit of each axis
  std::vector<double> q_;       // orthonormal columns
};

}  // namespace tess::m2m
