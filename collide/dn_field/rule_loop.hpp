// Second pass of a step over a block of particles: the rules. One template; make_stepper() picks
// the instance of its scene from a table, in which a rule that the scene has not got left no
// instruction. Private to the step loop.
//
// The flight of a step is given by its end velocity v1 and its way w, both exact for constant
// accelerations and linear drags. An impact happens at the fraction s of the step where the chord
// x + s w meets the surface; there the velocity is reflected, and the rest of the step
// is flown with the new one. Without drag the contact is placed on the parabola itself, so that the
// energy is kept to rounding.
//
// Branches on "any of the eight" save time and nothing else: what they skip must leave the other
// lanes their bits, the sign of a zero too, so that no particle depends on its neighbours.
#pragma once

#include "collide/dn_field/flight_lanes.hpp"
#include "collide/dn_field/flow_lanes.hpp"
#include "collide/dn_field/spring_lanes.hpp"

#include <vector>

namespace tess::dn {

enum class Impacts : std::uint32_t { none, plain, swept };
enum class Springs : std::uint32_t { none, exact };

/// A particle that goes further than is known to be free: left to trace(), see trace.hpp.
struct Untraced {
  std::size_t particle;  ///< in the block
  Vec3 position, start_velocity, end_velocity, way;
};

/// What the rule loop leaves for others.
struct Scratch {
  std::vector<Untraced> untraced;
  alignas(64) double energy[block_size];  ///< twice the energy a particle may have; springs only
};

struct RuleConstants : FlightConstants {
  double curved = 0;  ///< 1 where no drag bends the flight off its parabola, else 0
  double restitution = 0, threshold = 0;
  double slack = 0;   ///< depth below the threshold that is taken for the look-up's error
  double stride = 0;  ///< ways shorter than this are not traced
  FlowConstants flow;
  SpringConstants spring;
};

using RuleLoop = void (*)(const RuleConstants&, const ParticleSpan&, const Closest&, Scratch&);

namespace lanes {

template <Flight Flies, Impacts Hits, Springs Springy, Setting Where>
void rule_loop(const RuleConstants& constants,
               const ParticleSpan& span,
               const Closest& closest,
               Scratch& scratch) {
  // Copies, which no store to a particle can change.
  const RuleConstants c = constants;
  const ParticleSpan particles = span;
  constexpr bool asks_normal = Hits != Impacts::none || Springy != Springs::none;
  constexpr bool asks_distance = asks_normal || Flies == Flight::surface;
  constexpr bool moves = asks_distance && Where == Setting::general;
  const double dt = c.step;
  const D step = all(dt), half_step = all(0.5 * dt);
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D3 v0 = load3(particles.vx + p, particles.vy + p, particles.vz + p);
    D d{};
    D3 n{}, u{};
    L has_normal{};
    if constexpr (asks_distance) d = to_double(load<F>(closest.distance + p));
    if constexpr (asks_normal) {
      n = to_double(F3{load<F>(closest.nx + p), load<F>(closest.ny + p), load<F>(closest.nz + p)});
      const D square = dot(n, n);
      has_normal = settled(square > 0.25);
      n = refined(n, square);
    }
    if constexpr (moves) u = load3(closest.ux + p, closest.uy + p, closest.uz + p);

    const Flown flight = flown<Flies, moves>(c, v0, d, u);
    const D3 a = flight.a;
    const D keep = flight.keep, gain = flight.gain, way_keep = flight.way_keep,
            way_gain = flight.way_gain;
    D3 v1 = flight.v1, way = flight.way;

    // Along the normal all is scalar; velocities there are relative to the surface: `rise` at the
    // start, `rise1` at the end; `climb` is the way.
    [[maybe_unused]] D an{}, un{}, rise{}, rise1{}, climb{};
    if constexpr (asks_normal) {
      rise = rise1 = dot(n, v0);
      climb = way_keep * rise;
      if constexpr (Flies != Flight::none) {
        an = dot(n, a);
        rise1 = fma(keep, rise, gain * an);
        climb = fma(way_gain, an, climb);
      }
      if constexpr (moves) {
        un = dot(n, u);
        rise = rise - un, rise1 = rise1 - un, climb = fma(-step, un, climb);
      }
    }

    [[maybe_unused]] D z0{}, energy{}, energy1{}, change{}, work{};
    if constexpr (Springy != Springs::none) {
      z0 = d - c.spring.reach;
      const D3 w = moves ? v1 - u : v1;
      const D depth = min(z0, D{}), potential = c.spring.stiffness * depth * depth;
      energy1 = dot(w, w) + potential;
      const D g = an * gain * (1 / dt), e = fma(-gain, an, rise1);
      const L touches =
          settled(has_normal & ((z0 < 0.0) | (fma(step, fma(half_step, g, e), z0) < 0.0)));
      if constexpr (Hits != Impacts::none) energy = fma(rise, rise, fma(-2.0 * g, z0, potential));
      if (any(touches)) {
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
    }

    if constexpr (Hits != Impacts::none) {
      const L known = has_normal & (d < static_cast<double>(out_of_reach));
      L hits = settled(known & (climb < 0.0) & (d + climb < c.threshold));
      L deep = settled(known & (d < c.threshold - c.slack));
      if constexpr (Hits == Impacts::swept) {
        const D3 path = moves ? fma(-step, u, way) : way;
        const D free = max(to_double(load<F>(closest.free + p)), all(c.stride));
        L far = dot(path, path) > free * free;
        if constexpr (moves) far = far | widen(load<F>(closest.free + p) <= follow);
        far = settled(far);
        hits = hits & ~far;
        deep = deep & ~far;
        if (any(far))
          for (int i = 0; i < width; ++i)
            if (far[i] != 0) {
              const std::size_t k = p + static_cast<std::size_t>(i);
              const auto at = [i](D3 v) { return Vec3{v.x[i], v.y[i], v.z[i]}; };
              const Vec3 from{particles.x[k], particles.y[k], particles.z[k]};
              scratch.untraced.push_back({k, from, at(v0), at(v1), at(way)});
            }
      }
      if (any(hits | deep)) {
        D up = only(deep, c.threshold - c.slack - d);
        const D s = only(hits, max((c.threshold - d) / climb, D{}));
        const D rest = 1.0 - s;
        if constexpr (Flies == Flight::none && Springy == Springs::none) {
          const D kick = only(hits, -(1 + c.restitution) * rise);
          v1 = select(hits, fma(kick, n, v1), v1);
          up = fma(rest * dt, kick, up);
          store(particles.vx + p, v1.x), store(particles.vy + p, v1.y);
          store(particles.vz + p, v1.z);
        } else {
          const D3 met = fma(s, v1 - v0, v0);
          const D rise_met = fma(s, rise1 - rise, rise);
          D falls = rise_met;
          if constexpr (Springy != Springs::none) {
            // What the spring has not taken at the depth of the contact, and no more.
            const D zc = s > 0.0 ? min(z0, all(c.threshold - c.spring.reach)) : z0;
            const D depth = min(zc, D{});
            const D left =
                energy - c.spring.stiffness * depth * depth + 2.0 * an * gain * (1 / dt) * zc;
            falls = max(falls, -sqrt(max(left, D{})));
          }
          const D kick = only(falls < 0.0, -c.restitution * falls - rise_met);
          const D3 w = fma(kick, n, met);
          const D wn = rise_met + kick + un;
          // Back at the surface within the step: it rests there, and slides.
          const D sinks = rest * (way_keep * wn + rest * way_gain * an - dt * un);
          const L rests = sinks < 0.0;
          const D sinks1 = wn + rest * ((keep - 1.0) * wn + gain * an) - un;
          const D3 after = fma(rest, fma(keep - 1.0, w, gain * a), fma(-only(rests, sinks1), n, w));
          const D3 rest_way =
              fma(rest, fma(way_keep, w, (rest * way_gain) * a), -only(rests, sinks) * n);
          const D3 first_way = s * fma(c.curved * rest, step * v0 - way, way);
          if constexpr (Springy != Springs::none)
            work = hits ? dot(a, first_way + rest_way - fma(-change, n, way)) : work;
          v1 = select(hits, after, v1);
          way = select(hits, first_way + rest_way, way);
        }
        if constexpr (Springy != Springs::none) work = work + an * up;
        way = select(hits | deep, fma(up, n, way), way);
      }
    }
    if constexpr (Springy != Springs::none)
      store(scratch.energy + p, energy1 + 2.0 * (gain * (1 / dt)) * work);
    const D3 x1 = load3(particles.x + p, particles.y + p, particles.z + p) + way;
    store(particles.x + p, x1.x), store(particles.y + p, x1.y), store(particles.z + p, x1.z);
    constexpr bool stored = Flies == Flight::none && Springy == Springs::none;
    if constexpr (!stored) {
      store(particles.vx + p, v1.x), store(particles.vy + p, v1.y), store(particles.vz + p, v1.z);
    }
  }
}

}  // namespace lanes
}  // namespace tess::dn
