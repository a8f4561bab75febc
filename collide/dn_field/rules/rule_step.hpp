// One step of a vector of particles: the rules, in their order. Each rule is a function that reads
// the results of those before it; the compiler keeps the members in registers. A rule that the
// scene does not use leaves no instruction. Private to the step loop.
//
// The flight of a step is given by its end velocity v1 and its displacement `way`, both exact for
// constant accelerations and linear drags. An impact happens at the fraction s of the step at which
// x + s way meets the surface. There the velocity is reflected, and the rest of the step is flown
// with the new velocity. Without drag the contact lies on the parabola, so that the energy is kept
// to rounding.
//
// A branch on any() only saves time: the skipped code must not change a bit of the other lanes, not
// even the sign of a zero, so that no particle depends on its neighbours.
#pragma once

#include "collide/dn_field/rules/flight.hpp"
#include "collide/dn_field/rules/nearest_surface.hpp"
#include "collide/dn_field/rules/spring.hpp"
#include "collide/dn_field/rules/surface_flow.hpp"

#include <vector>

namespace tess::dn {

enum class Impacts : std::uint32_t { none, plain, swept };
enum class Springs : std::uint32_t { none, exact };

/// A particle that moves further than the free way: see continuous_collision.hpp.
struct Untraced {
  std::size_t particle;  ///< in the block
  Vec3 position, start_velocity, end_velocity, way;
};

/// Results of the rule loop besides the particles.
struct Scratch {
  std::vector<Untraced> untraced;
  std::vector<Waypoint> waypoints;  ///< particles are numbered in the block
  bool keeps_waypoints = false;
  alignas(64) double energy[block_size];  ///< twice the energy a particle may have; springs only
};

struct RuleConstants : FlightConstants {
  double curved = 0;   ///< 1 where the flight is a parabola (no drag), otherwise 0
  bool falls = false;  ///< whether one acceleration is all that acts: no drag, no spring
  double restitution = 0, threshold = 0;
  double slack = 0;   ///< depth below the threshold that may be the sample's error
  double sunk = 0;    ///< depth below that from which a particle is lifted at no cost
  double stride = 0;  ///< displacements below this are not traced
  FlowConstants flow;
  SpringConstants spring;
};

namespace lanes {

/// The part of `up` by which particles are lifted out of the surface. Where a particle `pays`, the
/// potential energy against the acceleration `falls` is taken from its velocity v relative to the
/// surface's u. The lift to the depth `sunk` costs nothing: a deeper particle started there.
inline D lifted(L pays, D up, D falls, double sunk, D3 u, D3& v) {
  const D3 w = v - u;
  const D square = dot(w, w);
  up = pays ? min(up, max(square / (2.0 * falls), up - sunk)) : up;
  const D left = max(square - 2.0 * falls * up, D{});
  v = select(pays & (square > 0.0), fma(sqrt(left / square), w, u), v);
  return up;
}

template <Flight Flies, Impacts Hits, Springs Springy, Setting Where>
struct RuleStep {
  static constexpr bool springs = Springy != Springs::none, hits_surface = Hits != Impacts::none;
  static constexpr bool asks_normal = hits_surface || springs;
  static constexpr bool asks_distance = asks_normal || Flies.drags == Drags::surface;
  static constexpr bool moves = asks_distance && Where == Setting::general;
  /// Whether only a bounce changes the velocity.
  static constexpr bool bounces_alone = Flies == Flight{} && !springs;

  const RuleConstants& c;
  std::size_t p;  ///< the first particle
  D3 v0;
  D d{};        ///< distance of the nearest surface
  D3 n{}, u{};  ///< its normal and velocity
  L has_normal{};
  Flown flight{};
  D3 v1{}, way{};
  // Components along the normal; velocities are relative to the surface.
  D an{}, un{};
  D rise{}, rise1{};  ///< velocity at the start, at the end
  D climb{};          ///< displacement
  // Springs only.
  D z0{};       ///< distance beyond the spring's reach
  D energy{};   ///< twice that of the motion along the normal
  D energy1{};  ///< twice that at the end, before impacts
  D change{};   ///< the spring's part of the displacement
  D work{};     ///< work of the acceleration along what springs and impacts added to `way`

  void look(const NearestSurface& nearest) {
    if constexpr (asks_distance) d = to_double(load<F>(nearest.distance + p));
    if constexpr (asks_normal) {
      n = to_double(normals(nearest, p));
      const D square = dot(n, n);
      has_normal = settled(square > 0.25);
      n = refined(n, square);
    }
    if constexpr (moves) u = surface_velocities(nearest, p);
  }

  void fly() {
    flight = flown<Flies, moves>(c, v0, d, u);
    v1 = flight.v1, way = flight.way;
    if constexpr (asks_normal) {
      rise = rise1 = dot(n, v0);
      climb = flight.way_keep * rise;
      if constexpr (Flies.drags != Drags::none) rise1 = flight.keep * rise;
      if constexpr (accelerates<Flies, moves>) {
        an = dot(n, flight.a);
        rise1 = fma(flight.keep, rise, flight.gain * an);
        climb = fma(flight.way_gain, an, climb);
      }
      if constexpr (moves) {
        un = dot(n, u);
        rise = rise - un, rise1 = rise1 - un, climb = fma(all(-c.step), un, climb);
      }
    }
  }

  void follow_spring() {
    const double dt = c.step;
    z0 = d - c.spring.reach;
    const D3 w = moves ? v1 - u : v1;
    const D depth = min(z0, D{}), potential = c.spring.stiffness * depth * depth;
    energy1 = dot(w, w) + potential;
    const D g = an * flight.gain * (1 / dt), e = fma(-flight.gain, an, rise1);
    const D z1 = fma(all(dt), fma(all(0.5 * dt), g, e), z0);
    const L touches = settled(has_normal & ((z0 < 0.0) | (z1 < 0.0)));
    if constexpr (hits_surface) energy = fma(rise, rise, fma(-2.0 * g, z0, potential));
    SpringMotion motion{};
    L stays{};
    if (c.spring.soft) {
      const SpringStay stay = spring_stay(c.spring, z0, e, g);
      motion = stay.motion, stays = stay.stays;
    }
    if (any(touches & ~stays)) {
      const SpringMotion whole = spring_motion(c.spring, z0, e, g, dt);
      motion.end = stays ? motion.end : whole.end;
      motion.rate = stays ? motion.rate : whole.rate;
    }
    const D kick = only(touches, motion.rate - rise1);
    change = only(touches, motion.end - z0 - climb);
    v1 = select(touches, fma(kick, n, v1), v1);
    way = select(touches, fma(change, n, way), way);
    rise1 = rise1 + kick;
    climb = climb + change;
    work = an * change;
  }

  /// Particles that move further than the free way.
  L goes_far(const NearestSurface& nearest) const {
    const D3 path = moves ? fma(all(-c.step), u, way) : way;
    const D free = max(to_double(load<F>(nearest.free + p)), all(c.stride));
    L far = dot(path, path) > free * free;
    if constexpr (moves) far = far | widen(load<F>(nearest.free + p) <= follow);
    return settled(far);
  }

  /// How far particles that are too deep are moved along the normal.
  D out_of(L deep) const { return only(deep, c.threshold - c.slack - d); }

  /// Where an acceleration points into the surface, the lift costs kinetic energy.
  D lift(L deep) {
    const D up = out_of(deep);
    if constexpr (accelerates<Flies, moves>) {
      const D falls = max(-an, D{});
      const L pays = settled(deep & (falls > 0.0));
      if (any(pays)) return lifted(pays, up, falls, c.sunk, u, v1);
    }
    return up;
  }

  /// A particle deep in the surface starts at the surface, or where the lift begins to cost.
  void leave_to_trace(L far, L deep, const ParticleSpan& particles, Scratch& scratch) {
    D up = out_of(far & deep);
    if constexpr (accelerates<Flies, moves>) up = an < 0.0 ? max(up - c.sunk, D{}) : up;
    const D3 from = fma(up, n, places(particles, p));
    if constexpr (springs) work = work + an * up;
    for (int i = 0; i < width; ++i) {
      if (far[i] == 0) continue;
      const auto at = [i](D3 v) { return Vec3{v.x[i], v.y[i], v.z[i]}; };
      scratch.untraced.push_back(
          {p + static_cast<std::size_t>(i), at(from), at(v0), at(v1), at(way)});
    }
  }

  /// Particles that meet the surface in the step; particles in it deeper than the sample's error.
  struct Met {
    L hits, deep;
  };
  Met meet() const {
    const L known = has_normal & (d < static_cast<double>(out_of_reach));
    return {settled(known & (climb < 0.0) & (d + climb < c.threshold)),
            settled(known & (d < c.threshold - c.slack))};
  }

  void bounce(Met met) {
    const L hits = met.hits;
    D up{};
    const D s = only(hits, max((c.threshold - d) / climb, D{})), rest = 1.0 - s;
    if constexpr (bounces_alone) {
      const D kick = only(hits, -(1 + c.restitution) * rise);
      v1 = select(hits, fma(kick, n, v1), v1);
      up = fma(rest * c.step, kick, out_of(met.deep));
    } else {
      fly_on(hits, s, rest);
      up = lift(met.deep);
    }
    if constexpr (springs) work = work + an * up;
    way = select(hits | met.deep, fma(up, n, way), way);
  }

  /// Reflects the particles that hit at the fraction s, and flies them through the rest.
  void fly_on(L hits, D s, D rest) {
    const D3 a = flight.a;
    const D keep = flight.keep, gain = flight.gain, way_keep = flight.way_keep,
            way_gain = flight.way_gain;
    const D3 met = fma(s, v1 - v0, v0);
    const D rise_met = fma(s, rise1 - rise, rise);
    D falls = rise_met;
    if constexpr (springs) {
      // At most the energy that the spring has not taken at the depth of the contact.
      const D zc = s > 0.0 ? min(z0, all(c.threshold - c.spring.reach)) : z0;
      const D depth = min(zc, D{});
      const D left =
          energy - c.spring.stiffness * depth * depth + 2.0 * an * gain * (1 / c.step) * zc;
      falls = max(falls, -sqrt(max(left, D{})));
    }
    const D kick = only(falls < 0.0, -c.restitution * falls - rise_met);
    const D3 w = fma(kick, n, met);
    const D wn = rise_met + kick + un;
    // A particle that returns to the surface within the step rests there and slides.
    const D sinks = rest * (way_keep * wn + rest * way_gain * an - c.step * un);
    const L rests = sinks < 0.0;
    const D sinks1 = wn + rest * ((keep - 1.0) * wn + gain * an) - un;
    const D3 after = fma(rest, fma(keep - 1.0, w, gain * a), fma(-only(rests, sinks1), n, w));
    const D3 rest_way = fma(rest, fma(way_keep, w, (rest * way_gain) * a), -only(rests, sinks) * n);
    const D3 first_way = s * fma(c.curved * rest, all(c.step) * v0 - way, way);
    if constexpr (springs) work = hits ? dot(a, first_way + rest_way - fma(-change, n, way)) : work;
    v1 = select(hits, after, v1);
    way = select(hits, first_way + rest_way, way);
  }
};

}  // namespace lanes
}  // namespace tess::dn
