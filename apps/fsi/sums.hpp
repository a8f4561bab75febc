// What the pieces of panel and fluid add up. The sums are exact, so that they do not depend on how
// the meshes are cut.
#pragma once

#include "apps/kit/worst.hpp"
#include "runtime/core/exact_sum.hpp"
#include "runtime/core/hash.hpp"

#include <array>
#include <cstdint>

namespace fsi {

/// Of residuals r, and the last ones s: r·r, s·(r - s), (r - s)·(r - s); and the largest of r.
struct Residual {
  std::array<tess::ExactSum, 3> sums{};
  double largest = 0;
};
struct JoinResiduals {
  Residual operator()(Residual a, const Residual& b) const {
    for (std::size_t i = 0; i < a.sums.size(); ++i) a.sums[i].add(b.sums[i]);
    kit::worsen(a.largest, b.largest);
    return a;
  }
};

/// Of forces f at places x with displacements d: Σ f, Σ x f, Σ y f, Σ f d, Σ |f|, Σ |f d|.
struct Balance {
  std::array<tess::ExactSum, 6> sums{};
  void add(double x, double y, double force, double displacement) {
    const double work = force * displacement;
    const std::array<double, 6> terms{force, x * force,       y * force,
                                      work,  std::abs(force), std::abs(work)};
    for (std::size_t i = 0; i < terms.size(); ++i) sums[i].add(terms[i]);
  }
};
struct JoinBalances {
  Balance operator()(Balance a, const Balance& b) const {
    for (std::size_t i = 0; i < a.sums.size(); ++i) a.sums[i].add(b.sums[i]);
    return a;
  }
};

struct Measured {
  tess::ExactSum energy;
  double error = 0;        ///< largest distance from the exact displacement
  std::uint64_t hash = 0;  ///< of all displacements, in no order
};
struct JoinMeasured {
  Measured operator()(Measured a, const Measured& b) const {
    a.energy.add(b.energy);
    kit::worsen(a.error, b.error);
    a.hash += b.hash;
    return a;
  }
};

}  // namespace fsi
