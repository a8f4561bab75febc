// The flight of a step without a surface. Accelerations and linear drags have an exact solution.
// Explosions and quadratic air drag change only the velocity. Quadratic drag, v' = -rate |v| v, takes
// a particle ln(1 + rate |v| step) / rate far: the flight begins with the velocity that goes there in
// a step, and afterwards that becomes v / (1 + rate |v| step). Both are exact where nothing else
// acts, and of second order in the step otherwise. Private to the step loop.
#pragma once

#include "collide/dn_field/geometry/lanes.hpp"
#include "collide/dn_field/rules.hpp"

#include <span>
#include <vector>

namespace tess::dn {

/// Linear drags: none, the same everywhere, or one more near the surface.
enum class Drags : std::uint32_t { none, everywhere, surface };

/// The rules that bend a flight or slow it down.
struct Flight {
  bool falls = false;  ///< an acceleration that is the same everywhere
  Drags drags = Drags::none;

  friend constexpr bool operator==(const Flight&, const Flight&) = default;
};

/// The exact solution of v' = -rate v + a over a step: v1 = keep v + gain a, and the displacement
/// is way_keep v + way_gain a.
struct LinearFlow {
  double keep = 1, gain = 0, way_keep = 0, way_gain = 0;
};

struct FlightConstants {
  double step = 0;
  LinearFlow air, surface;
  Vec3 acceleration;  ///< gravity + wind rate × wind velocity
  double surface_rate = 0, surface_threshold = 0;
};

/// An explosion in one step: kick × (1 − r/radius) away from `centre`.
struct Kick {
  Vec3 centre;
  double kick = 0, per_radius = 0;
};

/// What changes velocities in one step, apart from the flight.
struct VelocityChanges {
  std::vector<Kick> kicks;
  double drag = 0;  ///< rate × step of the quadratic air drag

  [[nodiscard]] bool none() const { return kicks.empty() && !(drag > 0); }
};

/// Explosions and quadratic air drag in [time, time + step].
[[nodiscard]] VelocityChanges velocity_changes(const Rules& rules, double time, double step);
void change_velocities_before(const VelocityChanges& changes, const ParticleSpan& particles);
void change_velocities_after(const VelocityChanges& changes, const ParticleSpan& particles);

/// Takes particles that feel no surface through as many steps as `changes` has.
using FreeLoop = void (*)(const FlightConstants&, const ParticleSpan&,
                          std::span<const VelocityChanges> changes);
[[nodiscard]] FreeLoop free_loop(Flight flight);

namespace lanes {

inline D3 kicked(const Kick& kick, D3 x, D3 v) {
  const D3 from = x - kick.centre;
  const D per_r = 1.0 / sqrt(dot(from, from));
  const L reached = (per_r > kick.per_radius) & (per_r < HUGE_VAL);  // the centre has no direction
  return select(reached, fma(kick.kick * (per_r - kick.per_radius), from, v), v);
}

/// The series below have rounding errors only up to here; beyond it arguments are halved.
inline constexpr double series_end = 0.1;

/// ln(1 + q) / q for q >= 0.
inline D mean_of_log(D q) {
  D factor = all(1.0);
  for (L large = q > series_end; any(large); large = q > series_end) {
    // ln(1 + q) = 2 ln(1 + p) for p = √(1 + q) - 1 = q per_root.
    const D per_root = 1.0 / (1.0 + sqrt(1.0 + q));
    q = large ? q * per_root : q;
    factor = large ? 2.0 * per_root * factor : factor;
  }
  const D per = 1.0 / (2.0 + q), s = (q * per) * (q * per);  // ln(1 + q) = 2 artanh(q / (2 + q))
  D sum = all(1.0 / 13);
  for (const double one : {1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0})
    sum = fma(sum, s, all(one));
  return 2.0 * per * factor * sum;
}

/// (1 - exp(-w)) / w for w >= 0.
inline D mean_of_exp(D w) {
  int n = 0;
  D n_halved{};
  for (L large = w > series_end; any(large); large = w > series_end, ++n) {
    w = large ? 0.5 * w : w;
    n_halved = large ? n_halved + 1.0 : n_halved;
  }
  D sum = all(1.0), per_place = w;
  for (int i = 9; i >= 2; --i) sum = fma(sum, -w / static_cast<double>(i), all(1.0));
  for (; n > 0; --n) {  // the mean over [0, 2w] from that over [0, w]
    const L halved = n_halved >= static_cast<double>(n);
    sum = halved ? sum * (1.0 - 0.5 * per_place * sum) : sum;
    per_place = halved ? 2.0 * per_place : per_place;
  }
  return sum;
}

/// The velocity that goes in a step as far as v does that quadratic drag slows down.
inline D3 mean_velocity(double rate_step, D3 v) {
  return mean_of_log(rate_step * sqrt(dot(v, v))) * v;
}
/// The velocity at the end of that step.
inline D3 last_velocity(double rate_step, D3 mean) {
  return mean_of_exp(rate_step * sqrt(dot(mean, mean))) * mean;
}

inline D3 changed_before(const VelocityChanges& changes, D3 x, D3 v) {
  for (const Kick& kick : changes.kicks) v = kicked(kick, x, v);
  return changes.drag > 0 ? mean_velocity(changes.drag, v) : v;
}

struct Flown {
  D3 v1, way;
  D3 a{};  ///< the acceleration
  D keep, gain{}, way_keep, way_gain{};
};

/// Whether anything accelerates: a surface that moves drags particles along.
template <Flight Flies, bool Moves>
inline constexpr bool accelerates = Flies.falls || (Moves && Flies.drags == Drags::surface);

/// A step's flight from velocity v0, at distance d from a surface that moves with velocity u.
template <Flight Flies, bool Moves>
inline Flown flown(const FlightConstants& c, D3 v0, [[maybe_unused]] D d, [[maybe_unused]] D3 u) {
  constexpr bool pushed = accelerates<Flies, Moves>;
  Flown f;
  f.keep = all(c.air.keep), f.way_keep = all(c.air.way_keep);
  if constexpr (pushed) {
    f.gain = all(c.air.gain), f.way_gain = all(c.air.way_gain);
    f.a = all(c.acceleration);
  }
  if constexpr (Flies.drags == Drags::surface) {
    const L near = d < c.surface_threshold;
    f.keep = near ? all(c.surface.keep) : f.keep;
    f.way_keep = near ? all(c.surface.way_keep) : f.way_keep;
    if constexpr (pushed) {
      f.gain = near ? all(c.surface.gain) : f.gain;
      f.way_gain = near ? all(c.surface.way_gain) : f.way_gain;
    }
    if constexpr (Moves) {
      const D3 dragged = all(c.surface_rate) * u;
      // Adding -0 changes no bits, so particles far from the surface fly as in the free loop.
      f.a =
          Flies.falls ? f.a + only(near, dragged) : select(near, dragged, all({-0.0, -0.0, -0.0}));
    }
  }
  f.v1 = v0;
  f.way = f.way_keep * v0;
  if constexpr (Flies.drags != Drags::none) f.v1 = f.keep * v0;
  if constexpr (pushed) {
    f.v1 = Flies.drags == Drags::none ? fma(f.gain, f.a, v0) : fma(f.keep, v0, f.gain * f.a);
    f.way = fma(f.way_keep, v0, f.way_gain * f.a);
  }
  return f;
}

}  // namespace lanes
}  // namespace tess::dn
