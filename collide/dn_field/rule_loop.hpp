// Second pass of a step over a block of particles: the rules. One template; make_stepper() picks
// the instance of its scene from a table, in which a rule that the scene has not got left no
// instruction. Private to the step loop.
//
// The flight of a step is given by its end velocity v1 and its mean velocity m, both exact for
// constant accelerations and linear drags. An impact happens at the fraction s of the step where
// the chord x + s dt m meets the surface; there the velocity is reflected, and the rest of the step
// is flown with the new one. Without drag the contact is placed on the parabola itself, so that the
// energy is kept to rounding.
//
// Branches on "any of the eight" save time and nothing else: what they skip must leave the other
// lanes their bits, the sign of a zero too, so that no particle depends on its neighbours.
#pragma once

#include "collide/dn_field/flow_lanes.hpp"
#include "collide/dn_field/spring_lanes.hpp"

#include <vector>

namespace tess::dn {

/// none: straight; fall: accelerations that are the same everywhere; air: also linear drags that
/// are; surface: also a linear drag near the surface.
enum class Flight : std::uint32_t { none, fall, air, surface };
enum class Impacts : std::uint32_t { none, plain, swept };
enum class Springs : std::uint32_t { none, exact };

/// The exact flow of v' = -rate v + a over a step: v1 = keep v + gain a, mean = mean_keep v +
/// mean_gain a.
struct LinearFlow {
  double keep = 1, gain = 0, mean_keep = 1, mean_gain = 0;
};

/// A particle that goes further than is known to be free: left to trace(), see trace.hpp.
struct Untraced {
  std::size_t particle;  ///< in the block
  Vec3 position, start_velocity, end_velocity, mean_velocity;
};

/// What the rule loop leaves for others.
struct Scratch {
  std::vector<Untraced> untraced;
  alignas(64) double energy[block_size];  ///< twice the energy a particle may have; springs only
};

struct RuleConstants {
  double step = 0;
  LinearFlow air, surface;
  double curved = 0;  ///< 1 where no drag bends the flight off its parabola, else 0
  Vec3 acceleration;  ///< gravity + wind rate × wind velocity
  double surface_rate = 0, surface_threshold = 0;
  double restitution = 0, threshold = 0;
  double slack = 0;   ///< depth below the threshold that is taken for the look-up's error
  double stride = 0;  ///< ways shorter than this are not traced
  FlowConstants flow;
  SpringConstants spring;
};

using RuleLoop = void (*)(const RuleConstants&, const ParticleSpan&, const Closest&, Scratch&);

namespace lanes {

inline D3 times(double s, D3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline D3 plus(D3 a, Vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline D dot(D3 a, Vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

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
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D3 x0 = load3(particles.x + p, particles.y + p, particles.z + p);
    const D3 v0 = load3(particles.vx + p, particles.vy + p, particles.vz + p);
    D d{};
    D3 n{}, u{};
    if constexpr (asks_distance) d = to_double(load<F>(closest.distance + p));
    if constexpr (asks_normal) {
      n = to_double(F3{load<F>(closest.nx + p), load<F>(closest.ny + p), load<F>(closest.nz + p)});
      if constexpr (Springy != Springs::none) n = refined(n);
    }
    if constexpr (moves) u = load3(closest.ux + p, closest.uy + p, closest.uz + p);
    // Relative to the surface.
    const auto relative = [&u](D3 v) {
      if constexpr (moves) return v - u;
      return v;
    };
    const auto rises = [&](D3 v) { return dot(n, relative(v)); };
    const L has_normal = asks_normal ? settled(dot(n, n) > 0.25) : L{};

    D3 v1 = v0, mean = v0, a{};
    D keep = all(1.0), gain{}, mean_keep = keep, mean_gain{};
    if constexpr (Flies != Flight::none) {
      keep = all(c.air.keep), gain = all(c.air.gain);
      mean_keep = all(c.air.mean_keep), mean_gain = all(c.air.mean_gain);
      a = plus(a, c.acceleration);
      if constexpr (Flies == Flight::surface) {
        const L near = d < c.surface_threshold;
        keep = near ? all(c.surface.keep) : keep;
        gain = near ? all(c.surface.gain) : gain;
        mean_keep = near ? all(c.surface.mean_keep) : mean_keep;
        mean_gain = near ? all(c.surface.mean_gain) : mean_gain;
        if constexpr (moves) a = a + only(near, times(c.surface_rate, u));
      }
      if constexpr (Flies == Flight::fall) {
        v1 = v0 + gain * a;
        mean = v0 + mean_gain * a;
      } else {
        v1 = keep * v0 + gain * a;
        mean = mean_keep * v0 + mean_gain * a;
      }
    }

    [[maybe_unused]] const D3 flight_end = v1, flight_mean = mean;
    [[maybe_unused]] D z0{}, energy{};
    if constexpr (Springy != Springs::none) {
      z0 = d - c.spring.reach;
      const D an = dot(n, a), g = an * gain * (1 / dt), before = rises(v1);
      const D e = before - gain * an;
      const L touches = settled(has_normal & ((z0 < 0.0) | ((z0 + dt * (e + 0.5 * dt * g)) < 0.0)));
      if constexpr (Hits != Impacts::none) {
        const D depth = min(z0, D{}), rate = rises(v0);
        energy = rate * rate + c.spring.stiffness * depth * depth - 2.0 * g * z0;
      }
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
        v1 = select(touches, v1 + (motion.rate - before) * n, v1);
        const D change = (motion.end - z0) * (1 / dt) - rises(mean);
        mean = select(touches, mean + change * n, mean);
      }
    }

    D3 way = times(dt, mean);
    if constexpr (Hits != Impacts::none) {
      const D rise = dt * rises(mean);
      const L known = has_normal & (d < static_cast<double>(out_of_reach));
      L hits = settled(known & (rise < 0.0) & (d + rise < c.threshold));
      L deep = settled(known & (d < c.threshold - c.slack));
      if constexpr (Hits == Impacts::swept) {
        const D3 path = times(dt, relative(mean));
        const D free = max(to_double(load<F>(closest.free + p)), all(c.stride));
        L far = dot(path, path) > free * free;
        if constexpr (moves) far = far | widen(load<F>(closest.free + p) <= follow);
        far = settled(far);
        hits = hits & ~far;
        deep = deep & ~far;
        if (any(far))
          for (int i = 0; i < width; ++i)
            if (far[i] != 0) {
              const auto at = [i](D3 v) { return Vec3{v.x[i], v.y[i], v.z[i]}; };
              scratch.untraced.push_back(
                  {p + static_cast<std::size_t>(i), at(x0), at(v0), at(v1), at(mean)});
            }
      }
      if (any(hits | deep)) {
        if constexpr (Springy == Springs::none) n = refined(n);
        D3 shift = only(deep, c.threshold - c.slack - d) * n;
        const D s = only(hits, max((c.threshold - d) / rise, D{}));
        const D rest = 1.0 - s;
        if constexpr (Flies == Flight::none && Springy == Springs::none) {
          const D kick = only(hits, -(1 + c.restitution) * rises(v0));
          v1 = select(hits, v1 + kick * n, v1);
          shift = shift + (rest * dt * kick) * n;
          store(particles.vx + p, v1.x), store(particles.vy + p, v1.y);
          store(particles.vz + p, v1.z);
        } else {
          const D3 met = v0 + s * (v1 - v0);
          D falls = rises(met);
          if constexpr (Springy != Springs::none) {
            // What the spring has not taken at the depth of the contact, and no more.
            const D zc = s > 0.0 ? min(z0, all(c.threshold - c.spring.reach)) : z0;
            const D depth = min(zc, D{});
            const D left = energy - c.spring.stiffness * depth * depth +
                           2.0 * dot(n, a) * gain * (1 / dt) * zc;
            falls = max(falls, -sqrt(max(left, D{})));
          }
          const D kick = only(falls < 0.0, -c.restitution * falls - rises(met));
          const D3 w = met + kick * n;
          D3 after = w + rest * ((keep - 1.0) * w + gain * a);
          D3 rest_way = (rest * dt) * (mean_keep * w + (rest * mean_gain) * a);
          // Back at the surface within the step: it rests there, and slides.
          D sinks = dot(n, rest_way);
          if constexpr (moves) sinks = sinks - rest * dt * dot(n, u);
          const L rests = sinks < 0.0;
          rest_way = rest_way - only(rests, sinks) * n;
          after = after - only(rests, rises(after)) * n;
          const D3 first_way = (s * dt) * (mean + (c.curved * rest) * (v0 - mean));
          v1 = select(hits, after, v1);
          way = select(hits, first_way + rest_way, way);
        }
        way = select(hits | deep, way + shift, way);
      }
    }
    if constexpr (Springy != Springs::none) {
      const D3 w = relative(flight_end);
      const D depth = min(z0, D{});
      store(scratch.energy + p,
            dot(w, w) + c.spring.stiffness * depth * depth +
                2.0 * (gain * (1 / dt)) * dot(a, way - times(dt, flight_mean)));
    }
    const D3 x1 = x0 + way;
    store(particles.x + p, x1.x), store(particles.y + p, x1.y), store(particles.z + p, x1.z);
    constexpr bool stored = Flies == Flight::none && Springy == Springs::none;
    if constexpr (!stored) {
      store(particles.vx + p, v1.x), store(particles.vy + p, v1.y), store(particles.vz + p, v1.z);
    }
  }
}

}  // namespace lanes
}  // namespace tess::dn
