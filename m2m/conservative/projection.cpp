#include "m2m/conservative/projection.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// Iterations end when the preconditioned residual has fallen by this factor, in the norm of the
/// energy. What is left is distributed by after_closing().
constexpr double residual_tolerance = 1e-15;
constexpr std::size_t most_iterations = 200;

}  // namespace

Projection::Projection(const MassMatrix& mass, std::size_t n_owned, std::size_t n_components,
                       std::vector<double> load, Form form, std::vector<ValueRange> bounds)
    : mass_(mass),
      n_owned_(n_owned),
      n_(n_components),
      form_(form),
      load_(std::move(load)),
      bounds_(std::move(bounds)) {
  const std::size_t n = mass.n_points() * n_;
  TESS_CHECK(load_.size() == n, "expected ", mass.n_points(), " rows of ", n_, " components, got ",
             load_.size(), " numbers");
  TESS_CHECK(bounds_.size() == (form == Form::bounded ? n : 0), "expected ",
             form == Form::bounded ? n : 0, " bounds, got ", bounds_.size());
  TESS_CHECK(n_owned <= mass.n_points(), n_owned, " owned vertices of ", mass.n_points());
}

Projection::Need Projection::step() {
  switch (stage_) {
    case Stage::start: {
      std::vector<double> diagonal(mass_.n_points(), 0.0), lumped(mass_.n_points(), 0.0);
      mass_.add_diagonals(diagonal, lumped);
      rows_.resize(2 * mass_.n_points());
      for (std::size_t v = 0; v < mass_.n_points(); ++v) {
        rows_[2 * v] = diagonal[v];
        rows_[2 * v + 1] = lumped[v];
      }
      stage_ = Stage::diagonals;
      return Need::copies;
    }
    case Stage::diagonals:
      return after_diagonals();
    case Stage::product:
      return after_product();
    case Stage::reduction:
      return after_reduction();
    case Stage::closing:
      return after_closing();
    case Stage::fluxes:
      return after_fluxes();
    case Stage::limited:
      return after_limited();
    case Stage::done:
      break;
  }
  return Need::nothing;
}

Projection::Need Projection::request_product(std::span<const double> x, Stage next) {
  rows_.assign(x.size(), 0.0);
  mass_.multiply_add(x, n_, rows_);
  stage_ = next;
  return Need::copies;
}

Projection::Need Projection::after_diagonals() {
  const std::size_t n_points = mass_.n_points();
  lumped_.resize(n_points);
  inverse_diagonal_.resize(n_points);
  x_.assign(n_points * n_, 0.0);
  for (std::size_t v = 0; v < n_points; ++v) {
    inverse_diagonal_[v] = rows_[2 * v] > 0 ? 1 / rows_[2 * v] : 0;
    lumped_[v] = rows_[2 * v] > 0 ? rows_[2 * v + 1] : 0;
    if (!(lumped_[v] > 0)) continue;
    for (std::size_t c = 0; c < n_; ++c) x_[v * n_ + c] = load_[v * n_ + c] / lumped_[v];
  }
  if (form_ == Form::lumped) return finish();
  if (form_ == Form::bounded) low_order_ = x_;
  return request_product(x_, Stage::product);
}

Projection::Need Projection::after_product() {
  if (first_product_) {  // of the start x
    first_product_ = false;
    residual_.resize(x_.size());
    for (std::size_t i = 0; i < x_.size(); ++i) residual_[i] = load_[i] - rows_[i];
    z_.assign(x_.size(), 0.0);
    p_.assign(x_.size(), 0.0);
    s_.assign(x_.size(), 0.0);
    gamma_.assign(n_, 0.0);
    alpha_.assign(n_, 0.0);
    for (std::size_t i = 0; i < x_.size(); ++i) z_[i] = inverse_diagonal_[i / n_] * residual_[i];
    return request_product(z_, Stage::product);
  }
  // rows_ = M z. One sum over all parts for both products: r·z and z·M z; at the first one also
  // load·D⁻¹load, which sets the scale.
  const bool first = n_iterations_ == 0;
  scalars_.assign((first ? 3 : 2) * n_, 0.0);
  for (std::size_t i = 0; i < n_owned_ * n_; ++i) {
    const std::size_t c = i % n_;
    scalars_[c] += residual_[i] * z_[i];
    scalars_[n_ + c] += rows_[i] * z_[i];
    if (first) scalars_[2 * n_ + c] += load_[i] * (inverse_diagonal_[i / n_] * load_[i]);
  }
  stage_ = Stage::reduction;
  return Need::parts;
}

Projection::Need Projection::after_reduction() {
  if (n_iterations_ == 0)
    first_gamma_.assign(scalars_.begin() + static_cast<std::ptrdiff_t>(2 * n_), scalars_.end());
  std::vector<double> beta(n_, 0.0);
  bool done = true;
  for (std::size_t c = 0; c < n_; ++c) {
    const double gamma = scalars_[c], delta = scalars_[n_ + c];
    const bool small = !(gamma > residual_tolerance * residual_tolerance * first_gamma_[c]);
    if (small) {
      alpha_[c] = 0;  // this component has converged; a NaN ends here, too
      gamma_[c] = 0;
      continue;
    }
    done = false;
    beta[c] = gamma_[c] > 0 ? gamma / gamma_[c] : 0;
    const double divisor = delta - (alpha_[c] != 0 ? beta[c] * gamma / alpha_[c] : 0);
    alpha_[c] = divisor > 0 ? gamma / divisor : gamma / delta;
    gamma_[c] = gamma;
  }
  if (done || n_iterations_ == most_iterations) return request_product(x_, Stage::closing);
  ++n_iterations_;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const std::size_t c = i % n_;
    p_[i] = z_[i] + beta[c] * p_[i];
    s_[i] = rows_[i] + beta[c] * s_[i];
    x_[i] += alpha_[c] * p_[i];
    residual_[i] -= alpha_[c] * s_[i];
    z_[i] = inverse_diagonal_[i / n_] * residual_[i];
  }
  return request_product(z_, Stage::product);
}

/// Distributes the residual that is left: after x += residual / m the sum of m x equals the sum of
/// the loads, whatever the tolerance was.
Projection::Need Projection::after_closing() {
  for (std::size_t i = 0; i < x_.size(); ++i)
    if (lumped_[i / n_] > 0) x_[i] += (load_[i] - rows_[i]) / lumped_[i / n_];
  if (form_ == Form::consistent) return finish();
  // Per vertex and component: the sums of positive and of negative fluxes into it.
  rows_.assign(2 * x_.size(), 0.0);
  for_each_flux([&](const Tet& tet, std::size_t c, const Weights& flux) {
    for (std::size_t a = 0; a < 4; ++a) {
      const std::size_t i = static_cast<std::size_t>(tet[a]) * n_ + c;
      rows_[2 * i + (flux[a] > 0 ? 1 : 0)] += flux[a];
    }
  });
  stage_ = Stage::fluxes;
  return Need::copies;
}

/// The difference of both solutions as contributions of tetrahedra, each of which adds up to zero:
/// m_i (consistent_i - lumped_i) = sum over T and j of M^T_ij (u_i - u_j), u = consistent.
template <class Visit>
void Projection::for_each_flux(Visit&& visit) const {
  mass_.for_each_element([&](const Tet& tet, const Matrix4& m) {
    for (std::size_t c = 0; c < n_; ++c) {
      Weights u, flux{};
      for (std::size_t a = 0; a < 4; ++a) u[a] = x_[static_cast<std::size_t>(tet[a]) * n_ + c];
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = a + 1; b < 4; ++b) {
          const double f = m[a][b] * (u[a] - u[b]);
          flux[a] += f;
          flux[b] -= f;
        }
      }
      visit(tet, c, flux);
    }
  });
}

Projection::Need Projection::after_fluxes() {
  ratios_.resize(x_.size());
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double down = lumped_[i / n_] * (bounds_[i].low - low_order_[i]);
    const double up = lumped_[i / n_] * (bounds_[i].high - low_order_[i]);
    const auto ratio = [](double admissible, double wanted) {
      if (wanted == 0) return 1.0;
      return std::clamp(admissible / wanted, 0.0, 1.0);
    };
    ratios_[i] = {ratio(std::min(down, 0.0), rows_[2 * i]),
                  ratio(std::max(up, 0.0), rows_[2 * i + 1])};
  }
  rows_.assign(x_.size(), 0.0);
  for_each_flux([&](const Tet& tet, std::size_t c, const Weights& flux) {
    double admitted = 1;
    for (std::size_t a = 0; a < 4; ++a) {
      const ValueRange& ratio = ratios_[static_cast<std::size_t>(tet[a]) * n_ + c];
      if (flux[a] != 0) admitted = std::min(admitted, flux[a] > 0 ? ratio.high : ratio.low);
    }
    for (std::size_t a = 0; a < 4; ++a)
      rows_[static_cast<std::size_t>(tet[a]) * n_ + c] += admitted * flux[a];
  });
  stage_ = Stage::limited;
  return Need::copies;
}

Projection::Need Projection::after_limited() {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double mass = lumped_[i / n_];
    if (!(mass > 0)) continue;
    x_[i] = low_order_[i] + rows_[i] / mass;
    // Exceeds the bounds by rounding only.
    if (bounds_[i].low <= bounds_[i].high)
      x_[i] = std::clamp(x_[i], bounds_[i].low, bounds_[i].high);
  }
  return finish();
}

Projection::Need Projection::finish() {
  rows_.clear();
  stage_ = Stage::done;
  return Need::nothing;
}

}  // namespace tess::m2m
