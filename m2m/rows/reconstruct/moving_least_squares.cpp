#include "m2m/rows/reconstruct/moving_least_squares.hpp"

#include "m2m/rows/reconstruct/gradient_fit.hpp"
#include "m2m/rows/reconstruct/terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tess::m2m {
namespace {

/// The farthest neighbour lies within the support, so that it has a weight.
constexpr double support = 1.1;
/// A direction whose extent is smaller than this part of the largest one is left out.
constexpr double least_extent_of_fit = 1e-10;
/// Times the rounding of the offsets: a smaller extent may be rounding.
constexpr double above_rounding = 32;
/// A direction in which the point lies more than so many extents from the neighbours' centroid is
/// left out.
constexpr double most_extents = 8;
/// One whose extent is below this part of the largest one may be left out before the order is.
constexpr double thin = 0.1;
/// So may one of which less than this part is independent of a quadratic polynomial of the wider
/// ones: on a sphere x² + y² + z² is constant, which leaves a quadratic in three directions open.
constexpr double least_part_of_axis = 0.2;
/// Neighbours do not determine a term if no more than this part of it is independent of others.
constexpr double least_part_of_term = 1e-4;
/// The sum of the magnitudes of weights: errors of values grow by so much at most.
constexpr double most_amplification = 10;

/// The terms of a polynomial at a point. Returns how many there are.
std::size_t terms_at(const Point& p, std::int32_t order, std::size_t n_axes, Terms::Numbers& out) {
  std::size_t n = 0;
  out[n++] = 1;
  for (std::size_t k = 0; k < n_axes; ++k) out[n++] = p[k];
  for (std::size_t k = 0; order == 2 && k < n_axes; ++k)
    for (std::size_t l = k; l < n_axes; ++l) out[n++] = p[k] * p[l];
  return n;
}

}  // namespace

void MovingLeastSquares::set_axes(const Point& at, std::span<const Point> neighbours) {
  const std::size_t n = neighbours.size();
  double reach = 0;
  for (const Point& x : neighbours) {
    const Point d = difference(x, at);
    reach = std::max(reach, dot(d, d));
  }
  reach = support * std::sqrt(reach);
  importance_.assign(n, 1);
  n_axes_ = 0;
  if (!(reach > 0)) return;
  local_.resize(n);
  double total = 0;
  Point centroid{};
  for (std::size_t j = 0; j < n; ++j) {
    local_[j] = difference(neighbours[j], at);
    for (double& x : local_[j]) x /= reach;
    const double s = std::sqrt(dot(local_[j], local_[j]));
    const double squared = (1 - s) * (1 - s), weight = squared * squared * (4 * s + 1);
    importance_[j] = std::sqrt(weight);
    total += weight;
    for (std::size_t k = 0; k < 3; ++k) centroid[k] += weight * local_[j][k];
  }
  for (double& x : centroid) x /= total;
  std::array<std::span<double>, 3> columns;
  columns_.resize(3 * n);
  for (std::size_t k = 0; k < 3; ++k) {
    columns[k] = std::span(columns_).subspan(k * n, n);
    for (std::size_t j = 0; j < n; ++j) {
      local_[j][k] -= centroid[k];
      columns[k][j] = importance_[j] * local_[j][k];
    }
  }
  std::array<Point, 3> axes{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
  orthogonalise(columns, axes);
  std::array<std::pair<double, std::size_t>, 3> extents;
  for (std::size_t k = 0; k < 3; ++k)
    extents[k] = {-std::sqrt(dot(columns[k], columns[k]) / total), k};
  std::sort(extents.begin(), extents.end());
  const double rounding = above_rounding * rounding_at(at) / reach;
  std::array<Point, 3> basis{};
  for (const auto& [minus, k] : extents) {
    const double extent = -minus, offset = -dot(centroid, axes[k]);
    if (!(extent > std::max(-least_extent_of_fit * extents[0].first, rounding)) ||
        std::abs(offset) > most_extents * extent)
      continue;
    extent_[n_axes_] = extent;
    local_at_[n_axes_] = offset / extent;
    basis[n_axes_++] = axes[k];
  }
  for (Point& p : local_) {
    const Point offset = p;
    for (std::size_t k = 0; k < n_axes_; ++k) p[k] = dot(offset, basis[k]) / extent_[k];
  }
}

void MovingLeastSquares::set_columns(std::int32_t order, std::size_t n_axes) {
  const std::size_t n = local_.size();
  Terms::Numbers row{};
  columns_.resize(terms_at({}, order, n_axes, row) * n);
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t n_terms = terms_at(local_[j], order, n_axes, row);
    for (std::size_t t = 0; t < n_terms; ++t) columns_[t * n + j] = importance_[j] * row[t];
  }
}

bool MovingLeastSquares::fits(std::int32_t order, std::size_t n_axes) {
  const std::size_t n = local_.size();
  Terms::Numbers to{};
  const std::size_t n_terms = terms_at(local_at_, order, n_axes, to);
  set_columns(order, n_axes);
  Terms terms(q_, n, least_part_of_term);
  for (std::size_t t = 0; t < n_terms; ++t)
    if (terms.append(std::span(columns_).subspan(t * n, n)) == 0) return false;
  const Terms::Numbers y = terms.solve(to);
  double amplification = 0;
  for (std::size_t j = 0; j < n; ++j) {
    double weight = 0;
    for (std::size_t t = 0; t < n_terms; ++t) weight += y[t] * q_[t * n + j];
    weights_[j] = importance_[j] * weight;
    amplification += std::abs(weights_[j]);
  }
  return amplification <= most_amplification;
}

bool MovingLeastSquares::follows(std::size_t axis) {
  const std::size_t n = local_.size();
  set_columns(2, axis);
  for (std::size_t j = 0; j < n; ++j) columns_.push_back(importance_[j] * local_[j][axis]);
  Terms terms(q_, n, 0);
  double part = 0;  // of the last column, which is the axis
  for (std::size_t at = 0; at < columns_.size(); at += n)
    part = terms.append(std::span(columns_).subspan(at, n));
  return part < least_part_of_axis;
}

MovingLeastSquares::Fit MovingLeastSquares::compute(const Point& at,
                                                    std::span<const Point> neighbours) {
  set_axes(at, neighbours);
  weights_.resize(neighbours.size());
  Terms::Numbers terms{};
  for (std::int32_t order = order_; order > 0; --order)
    for (std::size_t n = n_axes_; n > 0; --n) {
      const bool are_few = neighbours.size() < terms_at({}, order, n_axes_, terms);
      const bool is_wide = n < n_axes_ && extent_[n] > thin * extent_[0];
      if (are_few || (is_wide && !(order == 2 && follows(n)))) break;
      if (fits(order, n)) return {order, static_cast<std::int32_t>(n)};
    }
  double total = 0;
  for (const double s : importance_) total += s * s;
  for (std::size_t j = 0; j < weights_.size(); ++j)
    weights_[j] = importance_[j] * importance_[j] / total;
  return {0, 0};
}

}  // namespace tess::m2m
