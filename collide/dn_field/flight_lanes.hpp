// The free flight of a step: accelerations and linear drags, exact. Private to the step loop.
#pragma once

#include "collide/dn_field/lanes.hpp"

namespace tess::dn {

/// none: straight; fall: accelerations that are the same everywhere; air: also linear drags that
/// are; surface: also a linear drag near the surface.
enum class Flight : std::uint32_t { none, fall, air, surface };

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

/// From v0 at distance d of a surface that moves with u, where it does.
template <Flight Flies, bool Moves>
inline Flown flown(const FlightConstants& c, D3 v0, [[maybe_unused]] D d, [[maybe_unused]] D3 u) {
  Flown f;
  if constexpr (Flies == Flight::none) {
    f.keep = all(1.0), f.way_keep = all(c.step);
    f.v1 = v0;
    f.way = f.way_keep * v0;
    return f;
  }
  f.keep = all(c.air.keep), f.gain = all(c.air.gain);
  f.way_keep = all(c.air.way_keep), f.way_gain = all(c.air.way_gain);
  f.a = all(c.acceleration);
  if constexpr (Flies == Flight::surface) {
    const L near = d < c.surface_threshold;
    f.keep = near ? all(c.surface.keep) : f.keep;
    f.gain = near ? all(c.surface.gain) : f.gain;
    f.way_keep = near ? all(c.surface.way_keep) : f.way_keep;
    f.way_gain = near ? all(c.surface.way_gain) : f.way_gain;
    if constexpr (Moves) f.a = f.a + only(near, all(c.surface_rate) * u);
  }
  f.v1 = Flies == Flight::fall ? fma(f.gain, f.a, v0) : fma(f.keep, v0, f.gain * f.a);
  f.way = fma(f.way_keep, v0, f.way_gain * f.a);
  return f;
}

}  // namespace lanes
}  // namespace tess::dn
