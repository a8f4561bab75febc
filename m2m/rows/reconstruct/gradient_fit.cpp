#include "m2m/rows/reconstruct/gradient_fit.hpp"

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
/// Of a quadratic polynomial in three variables without its constant.
constexpr std::size_t all_terms = 9;

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// One-sided Jacobi (Hestenes 1958): rotates the three columns of `a` until they are orthogonal,
/// and the columns of `v` with them. Small singular values are as accurate as large ones.
void orthogonalise(std::array<std::span<double>, 3> a, std::array<Point, 3>& v) {
  for (int sweep = 0; sweep < 12; ++sweep) {
    bool rotated = false;
    for (std::size_t p = 0; p < 2; ++p) {
      for (std::size_t q = p + 1; q < 3; ++q) {
        const double alpha = dot(a[p], a[p]), beta = dot(a[q], a[q]), gamma = dot(a[p], a[q]);
        if (!(std::abs(gamma) > 1e-15 * std::sqrt(alpha * beta))) continue;
        rotated = true;
        const double zeta = (beta - alpha) / (2 * gamma);
        const double t = (zeta < 0 ? -1 : 1) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
        const double c = 1 / std::sqrt(1 + t * t), s = c * t;
        const auto rotate = [&](double& x, double& y) {
          const double old = x;
          x = c * old - s * y;
          y = s * old + c * y;
        };
        for (std::size_t i = 0; i < a[p].size(); ++i) rotate(a[p][i], a[q][i]);
        for (std::size_t i = 0; i < 3; ++i) rotate(v[p][i], v[q][i]);
      }
    }
    if (!rotated) return;
  }
}

/// The columns of a system, orthonormalised one by one (Gram-Schmidt, twice): Q and the triangular
/// R.
class Terms {
 public:
  /// `q` takes the columns of Q, of `n` numbers each.
  Terms(std::vector<double>& q, std::size_t n) : q_(q), n_(n) { q_.clear(); }

  [[nodiscard]] std::size_t size() const { return n_terms_; }
  /// Returns the part of the column that is independent of those before it; 0: it is left out.
  double append(std::span<double> column) {
    const double length = std::sqrt(dot(column, column));
    if (!(length > 0)) return 0;
    std::array<double, all_terms> along{};
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t t = 0; t < n_terms_; ++t) {
        const std::span<const double> q = std::span(q_).subspan(t * n_, n_);
        const double part = dot(q, column);
        along[t] += part;
        for (std::size_t j = 0; j < n_; ++j) column[j] -= part * q[j];
      }
    }
    const double rest = std::sqrt(dot(column, column));
    if (!(rest > least_independent * length)) return 0;
    for (double& x : column) x /= rest;
    along[n_terms_] = rest;
    r_[n_terms_++] = along;
    q_.insert(q_.end(), column.begin(), column.end());
    return rest / length;
  }
  /// The y with Rᵀ y = e_i: row i of the pseudo-inverse is Q y.
  [[nodiscard]] std::array<double, all_terms> solve(std::size_t i) const {
    std::array<double, all_terms> y{};
    for (std::size_t t = i; t < n_terms_; ++t) {
      double rest = t == i ? 1.0 : 0.0;
      for (std::size_t k = i; k < t; ++k) rest -= r_[t][k] * y[k];
      y[t] = rest / r_[t][t];
    }
    return y;
  }

 private:
  std::vector<double>& q_;
  std::size_t n_;
  std::size_t n_terms_ = 0;
  std::array<std::array<double, all_terms>, all_terms> r_{};  // by columns
};

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
  Terms terms(q_, n);
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
    const std::array<double, all_terms> y = terms.solve(i);
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
