// The spring's motion along the normal over one step, in closed form: free flight to the contact,
// damped oscillation in contact, free flight after it. Any stiffness × step² is stable. Private to
// the step loop.
//
// z: distance beyond the spring's reach (contact is z < 0), e: its rate, g: a constant
// acceleration. In contact z" = -k z - c z' + g, with ω² = k - c²/4 and γ = c/2.
#pragma once

#include "collide/dn_field/geometry/lanes.hpp"

namespace tess::dn {

struct SpringConstants {
  double stiffness = 1, omega = 1, gamma = 0, reach = 0;
  // A whole step in contact; `soft` where the step is short against the contact's duration.
  bool soft = false;
  double cosine = 1, sine = 0, kept = 1;
};

namespace lanes {

/// Nearest integer, for |v| < 2^51.
inline D round(D v) {
  constexpr double magic = 6755399441055744.0;  // 1.5 × 2^52
  return (v + magic) - magic;
}

/// Angle in [0, pi] of the point (x, y), y >= 0; 0 at the origin.
inline D angle_above(D y, D x) {
  const D ax = abs(x), low = min(y, ax), high = max(y, ax);
  D t = only(high > 0.0, low / high);
  const L steep = t > 0.41421356237309503;
  t = steep ? (t - 1.0) / (t + 1.0) : t;
  const D tt = t * t;
  D sum{};
  for (int k = 14; k >= 0; --k) sum = (k % 2 == 0 ? 1.0 : -1.0) / (2 * k + 1) + tt * sum;
  D angle = t * sum + only(steep, all(0.25 * pi));
  angle = y > ax ? 0.5 * pi - angle : angle;
  return x < 0.0 ? pi - angle : angle;
}

/// Sine and cosine of any angle up to about 1e9.
inline Turn turn_any(D angle) {
  constexpr double pi_high = 3.14159265160560607910, pi_low = 1.98418714791870343106e-9;
  const D half_turns = round(angle * (1 / pi));
  const Turn rest = turn((angle - half_turns * pi_high) - half_turns * pi_low);
  const L odd = (half_turns * 0.5) != round(half_turns * 0.5);
  return {odd ? -rest.cosine : rest.cosine, odd ? -rest.sine : rest.sine};
}

/// exp(-v) for v >= 0; relative error 1e-15.
inline D decay(D v) {
  constexpr double ln2_high = 0.693147180369123816490, ln2_low = 1.90821492927058770002e-10;
  v = min(v, all(700.0));
  const D n = round(v * 1.4426950408889634);
  const D r = (n * ln2_high - v) + n * ln2_low;  // -v + n ln 2, |r| < 0.35
  D sum = all(1.0);
  for (int k = 13; k >= 1; --k) sum = 1.0 + r * sum * (1.0 / k);
  const L exponent = (1023 - __builtin_convertvector(n, L)) << 52;
  return sum * (D)exponent;
}

struct SpringMotion {
  D end;   ///< z at the end of the step
  D rate;  ///< its rate there
};

/// The motion of particles in contact during the whole step (a fixed linear map), and which
/// particles those are.
struct SpringStay {
  SpringMotion motion;
  L stays;
};
inline SpringStay spring_stay(const SpringConstants& c, D z, D e, D g) {
  const D balance = g * (1 / c.stiffness), a = z - balance,
          b = fma(all(c.gamma), a, e) * (1 / c.omega);
  const D cosine = all(c.kept * c.cosine), sine = all(c.kept * c.sine);
  const D end = fma(cosine, a, fma(sine, b, balance));
  const D rate = fma(cosine, e, -sine * fma(all(c.gamma), b, c.omega * a));
  return {{end, rate}, (z < 0.0) & (end <= 0.0)};
}

/// The result is meaningless in lanes that do not come into contact.
inline SpringMotion spring_motion(const SpringConstants& c, D z0, D e, D g, double dt) {
  const L inside = z0 < 0.0;
  const D mean = e + 0.5 * dt * g;
  const D entry = inside ? D{} : min(z0 / (-mean), all(dt));  // time until contact
  const D time = dt - entry, v = e + g * entry, z = inside ? z0 : D{};
  // Leaving: the phase at which z returns to zero without g, and the speed by the energy with g.
  const D b = (v + c.gamma * z) * (1 / c.omega);
  const D leaving = angle_above(-z, b) * (1 / c.omega);
  const D kept = decay(c.gamma * leaving);
  const D speed2 = kept * kept * (z * z + b * b) * (c.omega * c.omega) - 2.0 * g * z;
  const L leaves = (leaving <= time) & (speed2 > 0.0);
  const D speed = sqrt(only(leaves, speed2)), left = only(leaves, time - leaving);
  D end = left * (speed + 0.5 * g * left), rate = speed + g * left;
  // A particle that would fall back within the step rests where spring and g balance.
  const D balance = g * (1 / c.stiffness);
  const L back = end < 0.0;
  end = back ? balance : end;
  rate = back ? D{} : rate;
  // A particle in contact until the end moves about the balance.
  const D a = z - balance, bb = (v + c.gamma * a) * (1 / c.omega);
  const Turn phase = turn_any(c.omega * time);
  const D damped = decay(c.gamma * time);
  const D stay_end = balance + damped * (a * phase.cosine + bb * phase.sine);
  const D stay_rate = damped * (v * phase.cosine - (c.gamma * bb + c.omega * a) * phase.sine);
  return {leaves ? end : stay_end, leaves ? rate : stay_rate};
}

}  // namespace lanes
}  // namespace tess::dn
