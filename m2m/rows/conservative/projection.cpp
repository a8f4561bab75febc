#include "m2m/rows/conservative/projection.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tess::m2m {
namespace {

/// The error falls by ((√5 - 1) / (√5 + 1))^2 = 0.146 in two steps: 1e-16 in 39.
constexpr std::uint32_t n_chebyshev_steps = 40;
constexpr double middle = 1.5, half_width = 1;  // of the interval of eigenvalues

}  // namespace

Projection::Projection(const MassMatrix& mass, std::size_t n_components, Form form,
                       std::vector<double> loads, std::vector<ValueRange> bounds)
    : n_(n_components), form_(form), load_(std::move(loads)), bounds_(std::move(bounds)) {
  TESS_CHECK(load_.size() == mass.n_owned() * n_, "expected ", mass.n_owned(), " loads of ", n_,
             " components, got ", load_.size(), " numbers");
  TESS_CHECK(bounds_.size() == (form == Form::bounded ? load_.size() : 0), "expected ",
             form == Form::bounded ? load_.size() : 0, " bounds, got ", bounds_.size());
  x_.assign(mass.n_points() * n_, 0);
}

std::span<double> Projection::shared() noexcept {
  return stage_ == Stage::limit ? ratios_ : x_;
}

bool Projection::step(const MassMatrix& mass) {
  switch (stage_) {
    case Stage::start:
      for (std::size_t i = 0; i < load_.size(); ++i) {
        const double m = mass.lumped()[i / n_];
        x_[i] = m > 0 ? load_[i] / m : 0;
      }
      if (form_ == Form::lumped) break;
      if (form_ == Form::bounded) low_order_.assign(x_.begin(), x_.begin() + std::ssize(load_));
      product_.resize(load_.size());
      direction_.assign(load_.size(), 0);
      stage_ = Stage::iterate;
      return true;
    case Stage::iterate:
      if (n_steps_ < n_chebyshev_steps) {
        chebyshev_step(mass);
        return true;
      }
      close(mass);
      if (form_ == Form::consistent) break;
      stage_ = Stage::fluxes;
      return true;
    case Stage::fluxes:
      find_ratios(mass);
      stage_ = Stage::limit;
      return true;
    case Stage::limit:
      add_limited(mass);
      break;
    case Stage::done:
      break;
  }
  stage_ = Stage::done;
  return false;
}

void Projection::chebyshev_step(const MassMatrix& mass) {
  mass.multiply(x_, n_, product_);
  double keep = 0, take = 1 / middle;
  if (n_steps_ == 0) {
    factor_ = half_width / middle;
  } else {
    const double next = 1 / (2 * middle / half_width - factor_);
    keep = next * factor_;
    take = 2 * next / half_width;
    factor_ = next;
  }
  ++n_steps_;
  for (std::size_t i = 0; i < load_.size(); ++i) {
    const double residual = mass.inverse_diagonal()[i / n_] * (load_[i] - product_[i]);
    direction_[i] = keep * direction_[i] + take * residual;
    x_[i] += direction_[i];
  }
}

/// Distributes the residual that is left: after x += residual / m the sum of m x equals the sum of
/// the loads, however many steps were taken.
void Projection::close(const MassMatrix& mass) {
  mass.multiply(x_, n_, product_);
  for (std::size_t i = 0; i < load_.size(); ++i) {
    const double m = mass.lumped()[i / n_];
    if (m > 0) x_[i] += (load_[i] - product_[i]) / m;
  }
}

/// The difference of both solutions as contributions of tetrahedra, each of which adds up to zero:
/// m_i (consistent_i - lumped_i) = sum over T and j of M^T_ij (u_i - u_j), u = consistent.
template <class Visit>
void Projection::for_each_flux(const MassMatrix& mass, const Visit& visit) const {
  mass.for_each_element([&](const Tet& tet, double e) {
    for (std::size_t c = 0; c < n_; ++c) {
      Weights u, flux{};
      for (std::size_t a = 0; a < 4; ++a) u[a] = x_[static_cast<std::size_t>(tet[a]) * n_ + c];
      for (std::size_t a = 0; a < mass.n_corners(); ++a) {
        for (std::size_t b = a + 1; b < mass.n_corners(); ++b) {
          const double f = e * (u[a] - u[b]);
          flux[a] += f;
          flux[b] -= f;
        }
      }
      visit(tet, c, flux);
    }
  });
}

void Projection::find_ratios(const MassMatrix& mass) {
  // Per point and component: the sums of negative and of positive fluxes into it.
  std::vector<double> wanted(2 * load_.size(), 0);
  for_each_flux(mass, [&](const Tet& tet, std::size_t c, const Weights& flux) {
    for (std::size_t a = 0; a < 4; ++a) {
      const std::size_t i = static_cast<std::size_t>(tet[a]) * n_ + c;
      if (i < load_.size()) wanted[2 * i + (flux[a] > 0 ? 1 : 0)] += flux[a];
    }
  });
  ratios_.assign(2 * x_.size(), 0);
  const auto ratio = [](double admissible, double flux) {
    return flux == 0 ? 1.0 : std::clamp(admissible / flux, 0.0, 1.0);
  };
  for (std::size_t i = 0; i < load_.size(); ++i) {
    const double m = mass.lumped()[i / n_];
    const double down = m * (bounds_[i].low - low_order_[i]);
    const double up = m * (bounds_[i].high - low_order_[i]);
    ratios_[2 * i] = ratio(std::min(down, 0.0), wanted[2 * i]);
    ratios_[2 * i + 1] = ratio(std::max(up, 0.0), wanted[2 * i + 1]);
  }
}

void Projection::add_limited(const MassMatrix& mass) {
  std::fill(product_.begin(), product_.end(), 0);
  for_each_flux(mass, [&](const Tet& tet, std::size_t c, const Weights& flux) {
    double admitted = 1;
    std::array<std::size_t, 4> at;
    for (std::size_t a = 0; a < 4; ++a) {
      at[a] = static_cast<std::size_t>(tet[a]) * n_ + c;
      if (flux[a] != 0) admitted = std::min(admitted, ratios_[2 * at[a] + (flux[a] > 0 ? 1 : 0)]);
    }
    for (std::size_t a = 0; a < 4; ++a)
      if (at[a] < load_.size()) product_[at[a]] += admitted * flux[a];
  });
  for (std::size_t i = 0; i < load_.size(); ++i) {
    const double m = mass.lumped()[i / n_];
    if (!(m > 0)) continue;
    x_[i] = low_order_[i] + product_[i] / m;
    // Exceeds the bounds by rounding only.
    if (bounds_[i].low <= bounds_[i].high)
      x_[i] = std::clamp(x_[i], bounds_[i].low, bounds_[i].high);
  }
}

}  // namespace tess::m2m
