// Straight parts of a particle's way through one step, as an object sees them that moves.
#pragma once

#include "collide/dn_field/frame.hpp"

#include <algorithm>

namespace tess::dn {

/// In the world; begin and end are fractions of the step.
struct Leg {
  double begin = 0, end = 1;
  Vec3 from, to;
};

/// How an object that stands as `frame` when the step begins stands at a fraction of it.
[[nodiscard]] inline Frame frame_at(Frame frame, double step, double part) {
  if (frame.is_moving() && part > 0) frame.advance(part * step);
  return frame;
}

/// Calls visit(from, to), in the object's coordinates, for one piece of the leg after the other
/// until one returns true; whether one did. The pieces are so short that they are straight as the
/// object sees them, though it spins: off by 3e-4 of the distance from its origin.
template <class Visit>
bool any_piece(const Frame& frame, double step, const Leg& leg, const Visit& visit) {
  constexpr double straight_turn = 0.05, most = 1000;
  if (!frame.is_moving()) return visit(frame.to_object(leg.from), frame.to_object(leg.to));
  const double last = leg.end - leg.begin,
               turns = norm(frame.angular_velocity) * step * last / straight_turn;
  const int n = 1 + static_cast<int>(std::min(turns, most));
  Vec3 from = frame_at(frame, step, leg.begin).to_object(leg.from);
  for (int i = 1; i <= n; ++i) {
    const double part = static_cast<double>(i) / n;
    const Vec3 to = frame_at(frame, step, leg.begin + part * last)
                        .to_object(leg.from + part * (leg.to - leg.from));
    if (visit(from, to)) return true;
    from = to;
  }
  return false;
}

}  // namespace tess::dn
