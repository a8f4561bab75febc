// The free flight of a step: accelerations and linear drags, exact. Private to the step loop.
#pragma once

#include "collide/dn_field/geometry/lanes.hpp"

namespace tess::dn {

/// Linear drags: none, those that are the same everywhere, also one near the surface.
enum class Drags : std::uint32_t { none, everywhere, surface };

/// What bends a flight or slows it down.
struct Flight {
  bool falls = false;  ///< accelerations that are the same everywhere
  Drags drags = Drags::none;

  friend constexpr bool operator==(const Flight&, const Flight&) = default;
};

/// The exact flow of v' = -rate v + a over a step: v1 = keep v + gain a, the way is way_keep v +
/// way_gain a.
struct LinearFlow {
  double keep = 1, gain = 0, way_keep = 0, way_gain = 0;
};

struct FlightConstants {
  double step = 0;
  LinearFlow air, surface;
  Vec3 acceleration;  ///< gravity + wind rate × wind velocity
  double surface_rate = 0, surface_threshold = 0;
};

namespace lanes {

struct Flown {
  D3 v1, way;
  D3 a{};  ///< what accelerated
  D keep, gain{}, way_keep, way_gain{};
};

/// Whether anything accelerates: a surface that moves drags particles along.
template <Flight Flies, bool Moves>
inline constexpr bool accelerates = Flies.falls || (Moves && Flies.drags == Drags::surface);

/// From v0 at distance d of a surface that moves with u, where it does.
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
      // A sum with -0 leaves every number its bits, as the free flight does.
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
