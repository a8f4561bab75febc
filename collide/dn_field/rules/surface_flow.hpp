// The surface flow, which changes only the velocity of particles near a surface. It is a loop of
// its own over a block: a chain of a root, a quotient and polynomials then overlaps with that of
// the next vector. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/nearest_surface.hpp"

namespace tess::dn {

struct FlowConstants {
  double turn_in = 0, turn_out = 0;  ///< alpha × step
  double distance = 0;
};

namespace lanes {

/// A power of two near 1 / sqrt(v), for 1e-300 < v < 1e300.
inline D scale_to_one(D v) {
  return (D)(((L{} + 0x5FE0000000000000) - ((L)v >> 1)) & (L{} + 0x7FF0000000000000));
}

/// tan(φ/2)/|n × w| of a turn by φ, positive away from n. φ is rate/|w|, limited to what leads to
/// the tangent or, for a negative rate, to the normal; a millionth less, so that rounding does not
/// lead beyond. The caller scales all squares to order 1.
inline F half_turn(F rate, F alpha, F w2, F axis2) {
  const F w = sqrt(w2), across = abs(alpha), along = sqrt(axis2);
  const F x = 0.5F * min(abs(rate) / w, all(0.5F * static_cast<float>(pi))), xx = x * x;
  // tan x = p/q, a continued fraction of five terms, has float precision for x <= pi/4.
  const F p = x * (945.0F + xx * (xx - 105.0F)), q = 945.0F + xx * (15.0F * xx - 420.0F);
  const I toward = rate > 0.0F;
  const F rest = (1 - 0x1p-20F) * (toward ? across : along), to = w + (toward ? along : across);
  const I arrives = p * to > rest * q;
  const F turn = (arrives ? rest : p) / ((arrives ? to : q) * along);
  return toward == (alpha > 0.0F) ? turn : -turn;
}

/// Turns the velocity w by alpha dt/|w| toward the tangent of the surface with normal n, at most
/// onto it; a negative alpha turns it away. Cayley's form of the turn about n × w,
///     w' = ((1 - g²(n × w)² + 2 g n·w) w - 2 g w² n) / (1 + g²(n × w)²),
/// keeps |w| to rounding for any g, so g = tan(φ/2)/|n × w| is computed in floats: their error in
/// φ is below that of a field's normal. A w along n to a millionth, or below 1e-100, is not turned.
inline D3 turned_to_surface(const FlowConstants& c, D3 w, D3 n, L where) {
  const D alpha = dot(w, n), w2 = dot(w, w);
  const D3 axis = cross(n, w);
  const D axis2 = dot(axis, axis);
  where = settled(where & (axis2 > 1e-12 * w2) & (w2 > 1e-200) & (w2 < 1e200));
  const D scale = scale_to_one(w2), rate = alpha < 0.0 ? all(c.turn_in) : all(c.turn_out);
  const F turn = half_turn(to_float(rate * scale), to_float(alpha * scale),
                           to_float(w2 * scale * scale), to_float(axis2 * scale * scale));
  const D g = to_double(turn) * scale, t2 = g * g * axis2, per = 1.0 / (1.0 + t2);
  const D of_w = fma(2.0 * g, alpha, 1.0 - t2) * per, of_n = -2.0 * g * w2 * per;
  return select(where, fma(of_w, w, of_n * n), w);
}

template <Setting Where>
void flow_loop(const FlowConstants& constants, const ParticleSpan& span,
               const NearestSurface& nearest) {
  const FlowConstants c = constants;  // copies, that no store to a particle can change
  const ParticleSpan particles = span;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const L near = to_double(load<F>(nearest.distance + p)) < c.distance;
    if (!any(near)) continue;
    const D3 n = to_double(normals(nearest, p)), v = velocities(particles, p);
    D3 w = v;
    if constexpr (Where == Setting::general) {
      const D3 u = surface_velocities(nearest, p);
      w = select(near, turned_to_surface(c, v - u, n, near) + u, v);
    } else {
      w = turned_to_surface(c, v, n, near);
    }
    set_velocities(particles, p, w);
  }
}

}  // namespace lanes

/// Turns the velocities of particles closer than the flow's distance.
inline void turn_to_surface(const FlowConstants& flow, Setting setting,
                            const ParticleSpan& particles, const NearestSurface& nearest) {
  lanes::with<Setting::one_at_rest, Setting::general>(
      setting, [&]<Setting Where> { lanes::flow_loop<Where>(flow, particles, nearest); });
}

}  // namespace tess::dn
