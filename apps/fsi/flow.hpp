// A piece of the fluid's wall. Its mesh is another one than the panel's. The displacement d that comes
// from there is that at the end of a step. The mean of the velocities at its start and at its end is
// (d - d₀) / Δt, and the force F, which is the same during the step, is what changes them:
//
//     F = - m_a (v - v₀) / Δt,   so that   F (d - d₀) = - m_a (v² - v₀²) / 2:
//
// what the panel works is what the fluid gains, and the codes together are as stable as each alone.
#pragma once

#include "apps/fsi/problem.hpp"
#include "apps/fsi/strip.hpp"
#include "apps/fsi/sums.hpp"
#include "m2m/coupling.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <span>
#include <vector>

namespace fsi {

class Flow : public tess::Chare<Flow, tess::Index1>, public tess::m2m::Piece<Flow> {
 public:
  Flow() = default;
  explicit Flow(const Problem& problem);

  /// The force that follows from the displacement that has come.
  void press();
  /// A step ends: what was reached is the start of the next one.
  void accept();
  void balance(tess::Callback<Balance> result);
  void measure(tess::Callback<Measured> result);

  // What the couplings call.
  [[nodiscard]] tess::m2m::MeshView mesh_view() const { return strip_.view(); }
  [[nodiscard]] std::span<double> displacement() { return d_; }
  [[nodiscard]] std::span<const double> force() const { return force_; }

  [[nodiscard]] std::array<double, 3> balance_position() const { return {double(index().x), 0, 0}; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(couplings, problem_, strip_, d_, d_start_, v_start_, force_);
  }

 private:
  /// At the end of the step.
  [[nodiscard]] double velocity(std::size_t point) const;

  Problem problem_;
  Strip strip_;
  std::vector<double> d_;                  // per point owned
  std::vector<double> d_start_, v_start_;  // where the step began
  std::vector<double> force_;              // per point
};

}  // namespace fsi
