// Rules that change nothing but the velocity and that no surface has a part in: explosions and
// quadratic air drag. Private to the step loop.
#pragma once

#include "collide/dn_field/geometry/lanes.hpp"

#include <vector>

namespace tess::dn {

/// An explosion in one step: kick × (1 − r/radius) away from `centre`.
struct Kick {
  Vec3 centre;
  double kick = 0, per_radius = 0;
};

/// What acts in one step.
struct VelocityChanges {
  std::vector<Kick> kicks;
  double drag = 0;  ///< rate × step of the quadratic air drag

  [[nodiscard]] bool none() const { return kicks.empty() && !(drag > 0); }
};

namespace lanes {

inline D3 kicked(const Kick& kick, D3 x, D3 v) {
  const D3 from = x - kick.centre;
  const D per_r = 1.0 / sqrt(dot(from, from));
  const L reached = (per_r > kick.per_radius) & (per_r < HUGE_VAL);  // the centre has no direction
  return select(reached, fma(kick.kick * (per_r - kick.per_radius), from, v), v);
}

/// v / (1 + rate |v| step), the exact solution of v' = -rate |v| v.
inline D3 slowed(double rate_step, D3 v) {
  return (1.0 / (1.0 + rate_step * sqrt(dot(v, v)))) * v;
}

inline D3 changed(const VelocityChanges& changes, D3 x, D3 v) {
  for (const Kick& kick : changes.kicks) v = kicked(kick, x, v);
  return changes.drag > 0 ? slowed(changes.drag, v) : v;
}

}  // namespace lanes
}  // namespace tess::dn
