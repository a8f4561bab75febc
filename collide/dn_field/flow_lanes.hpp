// The surface flow, a loop of its own over a block before the rule loop: its long chain of a root,
// a quotient and polynomials then overlaps from one vector to the next. Private to the step loop.
#pragma once

#include "collide/dn_field/closest.hpp"

namespace tess::dn {

struct FlowConstants {
  double turn_in = 0, turn_out = 0;  ///< alpha × step
  double distance = 0;
};

namespace lanes {

/// 1 / sqrt(v) to 4e-11, for 1e-200 < v < 1e200: a first guess from the halved exponent and three
/// Newton steps, so that all machines agree, which have instructions for it that do not.
inline D rough_inverse_root(D v) {
  D y = (D)((L{} + 0x5FE6EB50C7B537A9) - ((L)v >> 1));
  const D half = 0.5 * v;
  for (int k = 0; k < 3; ++k) y = y * (1.5 - half * y * y);
  return y;
}

/// The velocity w turned toward the tangent of the surface with normal n by min(alpha dt/|w|, what
/// is left); by a negative alpha away from it. |w| is kept to rounding; 1e-100 is no speed.
inline D3 turned_to_surface(const FlowConstants& c, D3 w, D3 n, L where) {
  const D alpha = dot(w, n);
  const D3 tangent = w - alpha * n;
  const D w2 = dot(w, w), t2 = dot(tangent, tangent);
  where = settled(where & (t2 > 1e-24 * w2) & (w2 > 1e-200) & (w2 < 1e200));
  const D rate = alpha < 0.0 ? all(c.turn_in) : all(c.turn_out);
  const D angle = rate * rough_inverse_root(w2);
  const TurnRatio by = turn_ratio(max(min(angle, all(0.5 * pi)), all(-0.5 * pi)));
  // Along the tangent and across it, both times by.square.
  const D t = sqrt(t2), up = abs(alpha);
  const D sine = up * by.cosine - t * by.sine, cosine = t * by.cosine + up * by.sine;
  const D scale = 1.0 / (by.square * t);
  D along = cosine * scale, across = (sine * t) * scale;
  const L arrived = sine < 0.0, upright = cosine < 0.0;
  if (any(where & (arrived | upright))) {
    const D speed = sqrt(w2);
    along = arrived ? speed / t : only(cosine >= 0.0, along);
    across = arrived ? D{} : (upright ? speed : across);
  }
  across = alpha < 0.0 ? -across : across;
  return select(where, along * tangent + across * n, w);
}

template <Setting Where>
void flow_loop(const FlowConstants& constants, const ParticleSpan& span, const Closest& closest) {
  const FlowConstants c = constants;  // copies, which no store to a particle can change
  const ParticleSpan particles = span;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const L near = to_double(load<F>(closest.distance + p)) < c.distance;
    if (!any(near)) continue;
    const D3 n = refined(
        to_double(F3{load<F>(closest.nx + p), load<F>(closest.ny + p), load<F>(closest.nz + p)}));
    const D3 v = load3(particles.vx + p, particles.vy + p, particles.vz + p);
    const L turns = near & (dot(n, n) > 0.25);
    D3 w = v;
    if constexpr (Where == Setting::general) {
      const D3 u = load3(closest.ux + p, closest.uy + p, closest.uz + p);
      w = select(turns, turned_to_surface(c, v - u, n, turns) + u, v);
    } else {
      w = turned_to_surface(c, v, n, turns);
    }
    store(particles.vx + p, w.x), store(particles.vy + p, w.y), store(particles.vz + p, w.z);
  }
}

}  // namespace lanes
}  // namespace tess::dn
