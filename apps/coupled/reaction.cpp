#include "apps/coupled/reaction.hpp"

#include <cmath>

namespace coupled {

double Reaction::rate(double u) const {
  return u < threshold ? 0 : factor * std::exp(-activation / u);
}

double Reaction::step(double before, double exact, double dt, std::uint64_t& n) const {
  constexpr int most_iterations = 50;
  const double of_substep = dt / n_substeps, source = of_substep * rate(exact);
  double u = before;
  for (std::int32_t substep = 0; substep < n_substeps; ++substep) {
    const double known = u + source;
    for (int k = 0; k < most_iterations && u >= threshold; ++k) {
      ++n;
      const double burnt = of_substep * rate(u);
      const double change = (known - u - burnt) / (1 + burnt * activation / (u * u));
      u += change;
      if (std::abs(change) <= 1e-14) break;
    }
  }
  return u;
}

}  // namespace coupled
