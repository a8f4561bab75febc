#include "m2m/rows/reconstruct/gradient_fit.hpp"

#include "m2m/rows/reconstruct/terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

/// A direction whose extent is smaller than this part of the largest one is left out.
constexpr double least_extent = 1e-13;
/// Times the rounding of the offsets: a smaller extent may be rounding.
constexpr double clearly = 32;
/// A direction in which the arms reach more than so many times as far as the neighbours is left
/// out: in a single layer the neighbours' distances across it are rounding or curvature.
constexpr double most_extrapolation = 4;
/// In principal axes, where the root mean square of each coordinate is 1: neighbours at smaller
/// distances, whose differences may be rounding, count as those at this one.
constexpr double least_distance = 1e-3;
/// A term is dropped if less than this part of it is independent of the terms before it.
constexpr double least_independent = 0.05;

}  // namespace

double rounding_at(const Point& p) noexcept {
  const double largest = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
  return largest * std::numeric_limits<double>::epsilon();
}

/// Fills axes_ and basis_; returns the number of directions with an extent.
std::size_t GradientFit::principal_axes(std::span<const Point> offsets, double rounding,
                                        std::span<const Point> arms) {
  const std::size_t n = offsets.size();
  double reach = 0;
  for (const Point& d : offsets)
    for (const double x : d) reach = std::max(reach, std::abs(x));
  axes_.assign(3 * n, 0.0);
  if (!(reach > 0)) return 0;
  std::array<std::span<double>, 3> columns;
  for (std::size_t k = 0; k < 3; ++k) {
    columns[k] = std::span(axes_).subspan(k * n, n);
    for (std::size_t j = 0; j < n; ++j) columns[k][j] = offsets[j][k] / reach;
  }
  std::array<Point, 3> v{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
  orthogonalise(columns, v);
  std::array<double, 3> extent;
  for (std::size_t k = 0; k < 3; ++k)
    extent[k] = std::sqrt(dot(columns[k], columns[k]) / static_cast<double>(n));
  const double largest = *std::max_element(extent.begin(), extent.end());
  std::size_t n_axes = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(extent[k] > std::max(least_extent * largest, clearly * rounding / reach))) continue;
    double farthest = 0, own = 0;
    for (const double x : columns[k]) farthest = std::max(farthest, std::abs(x));
    for (const Point& arm : arms) own = std::max(own, std::abs(dot(arm, v[k])) / reach);
    if (own > most_extrapolation * farthest) continue;
    for (std::size_t j = 0; j < n; ++j) columns[n_axes][j] = columns[k][j] / extent[k];
    for (std::size_t i = 0; i < 3; ++i) basis_[n_axes][i] = v[k][i] / extent[k] / reach;
    ++n_axes;
  }
  return n_axes;
}

double GradientFit::compute(std::span<const Point> offsets, FitDegree degree, double rounding,
                            std::span<const Point> arms) {
  const std::size_t n = offsets.size();
  weights_.assign(n, Point{});
  const std::size_t n_axes = principal_axes(offsets, rounding, arms);
  const auto axis = [&](std::size_t k) { return std::span(axes_).subspan(k * n, n); };
  std::vector<double> importance(n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    double squared = 0;
    for (std::size_t k = 0; k < n_axes; ++k) squared += axis(k)[j] * axis(k)[j];
    importance[j] = 1 / std::max(std::sqrt(squared), least_distance);
  }
  // Linear terms come first: they are independent of each other, because the axes are orthogonal.
  Terms terms(q_, n, least_independent);
  double determined = n_axes == 3 ? 1 : 0;
  std::vector<double> column(n);
  for (std::size_t k = 0; k < n_axes; ++k) {
    for (std::size_t j = 0; j < n; ++j) column[j] = importance[j] * axis(k)[j];
    determined = std::min(determined, terms.append(column));
  }
  const std::size_t n_linear = terms.size();
  if (n_linear < n_axes) return 0;  // cannot be but for numbers that are not finite
  if (degree == FitDegree::quadratic) {
    for (std::size_t k = 0; k < n_axes; ++k) {
      for (std::size_t l = k; l < n_axes; ++l) {
        for (std::size_t j = 0; j < n; ++j) column[j] = importance[j] * axis(k)[j] * axis(l)[j];
        determined = std::min(determined, terms.append(column));
      }
    }
  }
  for (std::size_t i = 0; i < n_linear; ++i) {
    Terms::Numbers unit{};
    unit[i] = 1;
    const Terms::Numbers y = terms.solve(unit);
    for (std::size_t j = 0; j < n; ++j) {
      double weight = 0;
      for (std::size_t t = i; t < terms.size(); ++t) weight += y[t] * q_[t * n + j];
      weight *= importance[j];
      for (std::size_t k = 0; k < 3; ++k) weights_[j][k] += weight * basis_[i][k];
    }
  }
  return determined;
}

}  // namespace tess::m2m
