// The path of a particle through one step as straight segments, as seen from an object that moves:
// for audits, which test the segments against surfaces.
#pragma once

#include "collide/dn_field/stepper.hpp"

#include <algorithm>

namespace tess::dn {

/// A segment in the world; begin and end are fractions of the step.
struct PathSegment {
  double begin = 0, end = 1;
  Vec3 from, to;
};

/// Sets `segments` to the path of particle p through a step. waypoints: the result of
/// Stepper::run_once().
inline void path_segments(std::size_t p, Vec3 from, std::span<const Waypoint> waypoints, Vec3 to,
                          std::vector<PathSegment>& segments) {
  segments.assign(1, {0, 1, from, to});
  for (const Waypoint& bend : std::ranges::equal_range(waypoints, p, {}, &Waypoint::particle)) {
    segments.back().end = bend.part, segments.back().to = bend.place;
    segments.push_back({bend.part, 1, bend.place, to});
  }
}

/// The frame at a fraction of a step that begins with `frame`.
[[nodiscard]] inline Frame frame_at(Frame frame, double step, double part) {
  if (frame.is_moving() && part > 0) frame.advance(part * step);
  return frame;
}

/// Calls visit(from, to) in the object's coordinates for each piece of the segment, until a call
/// returns true; returns whether one did. Seen from an object that spins the pieces are straight up
/// to 3e-4 of the distance from its origin.
template <class Visit>
bool any_piece(const Frame& frame, double step, const PathSegment& segment, const Visit& visit) {
  constexpr double straight_turn = 0.05, most = 1000;
  if (!frame.is_moving()) return visit(frame.to_object(segment.from), frame.to_object(segment.to));
  const double last = segment.end - segment.begin,
               turns = norm(frame.angular_velocity) * step * last / straight_turn;
  const int n = 1 + static_cast<int>(std::min(turns, most));
  Vec3 from = frame_at(frame, step, segment.begin).to_object(segment.from);
  for (int i = 1; i <= n; ++i) {
    const double part = static_cast<double>(i) / n;
    const Vec3 to = frame_at(frame, step, segment.begin + part * last)
                        .to_object(segment.from + part * (segment.to - segment.from));
    if (visit(from, to)) return true;
    from = to;
  }
  return false;
}

}  // namespace tess::dn
