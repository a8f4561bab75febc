// What the pieces of panel and fluid add up. The sums are exact, so that they do not depend on how
// the meshes are cut.
#pragma once

#include "apps/fsi/strip.hpp"
#include "apps/kit/worst.hpp"
#include "runtime/core/exact_sum.hpp"
#include "runtime/core/hash.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace fsi {

/// Holds, for residuals r and the last ones s, r·r, s·(r - s), (r - s)·(r - s), and the largest r.
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

/// Holds, for forces f at places x with displacements d, Σ f, Σ x f, Σ y f, Σ f d, Σ |f|, Σ |f d|.
struct Balance {
  std::array<tess::ExactSum, 6> sums{};
};
/// Sums over the points that a piece owns.
inline Balance balance_of(const Strip& strip, std::span<const double> forces,
                          std::span<const double> displacements) {
  Balance mine;
  for (std::size_t i = 0; i < strip.n_owned(); ++i) {
    const Point& p = strip.points()[i];
    const double f = forces[i], work = f * displacements[i];
    const std::array terms{f, p[0] * f, p[1] * f, work, std::abs(f), std::abs(work)};
    for (std::size_t k = 0; k < terms.size(); ++k) mine.sums[k].add(terms[k]);
  }
  return mine;
}
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
