#include "m2m/rows/reconstruct/terms.hpp"

#include <cmath>

namespace tess::m2m {

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

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

double Terms::append(std::span<double> column) {
  const double length = std::sqrt(dot(column, column));
  if (!(length > 0)) return 0;
  Numbers along{};
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t t = 0; t < n_terms_; ++t) {
      const std::span<const double> q = std::span(q_).subspan(t * n_, n_);
      const double part = dot(q, column);
      along[t] += part;
      for (std::size_t j = 0; j < n_; ++j) column[j] -= part * q[j];
    }
  }
  const double rest = std::sqrt(dot(column, column));
  if (!(rest > least_independent_ * length)) return 0;
  for (double& x : column) x /= rest;
  along[n_terms_] = rest;
  r_[n_terms_++] = along;
  q_.insert(q_.end(), column.begin(), column.end());
  return rest / length;
}

Terms::Numbers Terms::solve(const Numbers& to) const {
  Numbers y{};
  for (std::size_t t = 0; t < n_terms_; ++t) {
    double rest = to[t];
    for (std::size_t k = 0; k < t; ++k) rest -= r_[t][k] * y[k];
    y[t] = rest / r_[t][t];
  }
  return y;
}

}  // namespace tess::m2m
