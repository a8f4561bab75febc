// The flight of a step without a surface. Accelerations and linear drags have an exact solution.
// Explosions and quadratic air drag change only the velocity; quadratic drag acts for half a step
// before and half a step after the flight, which is of second order in the step (Strang 1968), and
// exact for the velocity where nothing else acts. Private to the step loop.
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
  double half_drag = 0;  ///< rate × step / 2 of the quadratic air drag

  [[nodiscard]] bool none() const { return kicks.empty() && !(half_drag > 0); }
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

/// The exact solution of v' = -rate |v| v: v / (1 + rate × time × |v|).
inline D3 slowed(double rate_time, D3 v) {
  return (1.0 / (1.0 + rate_time * sqrt(dot(v, v)))) * v;
}

inline D3 changed_before(const VelocityChanges& changes, D3 x, D3 v) {
  for (const Kick& kick : changes.kicks) v = kicked(kick, x, v);
  return changes.half_drag > 0 ? slowed(changes.half_drag, v) : v;
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
