// Straight parts of a particle's way through one step, as an object sees them that moves.
#pragma once

#include "collide/dn_field/stepper.hpp"

#include <algorithm>

namespace tess::dn {

/// In the world; begin and end are fractions of the step.
struct Leg {
  double begin = 0, end = 1;
  Vec3 from, to;
};

/// Fills `legs` with particle p's way through a step, in the order of time. waypoints: those of all
/// particles, as Stepper::run_once() tells them.
inline void find_legs(std::size_t p, Vec3 from, std::span<const Waypoint> waypoints, Vec3 to,
                      std::vector<Leg>& legs) {
  legs.assign(1, {0, 1, from, to});
  for (const Waypoint& bend : std::ranges::equal_range(waypoints, p, {}, &Waypoint::particle)) {
    legs.back().end = bend.part, legs.back().to = bend.place;
    legs.push_back({bend.part, 1, bend.place, to});
  }
}

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
