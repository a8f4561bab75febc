// A substance that burns: its rate by Arrhenius's law, A exp(-E/u), where u is above a threshold.
// It is stiff, so a step has many implicit substeps, and it costs time only where the field is
// warm.
#pragma once

#include <cstdint>

namespace coupled {

/// A reaction with a source that balances it where u is the exact solution.
struct Reaction {
  double factor = 0;  ///< A; 0: nothing burns
  std::int32_t n_substeps = 20;

  /// Below this nothing burns, and nothing is computed.
  static constexpr double threshold = 0.9;
  static constexpr double activation = 4;

  [[nodiscard]] double rate(double u) const;
  /// du/dt = rate(exact) - rate(u) over dt, by backward Euler; each substep is solved by Newton's
  /// method, to rounding. Adds the number of iterations to `n`.
  [[nodiscard]] double step(double before, double exact, double dt, std::uint64_t& n) const;
};

}  // namespace coupled
