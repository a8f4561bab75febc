// A piece of the fluid's wall. Its mesh is another one than the panel's. The displacement that comes
// from there is that at the end of a step; the acceleration, and with it the pressure, follows by
// Newmark's average acceleration.
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

  /// The pressure of the displacement that has come, as forces on the points.
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
    ar(couplings, problem_, strip_, d_, a_, d_start_, v_start_, a_start_, force_);
  }

 private:
  Problem problem_;
  Strip strip_;
  std::vector<double> d_, a_;                        // per point owned
  std::vector<double> d_start_, v_start_, a_start_;  // where the step began
  std::vector<double> force_;
};

}  // namespace fsi
