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

/// The part of the segment on which the object's grid may be: within a ball around its origin.
[[nodiscard]] inline LinePart part_near(const Object& object, double step,
                                        const PathSegment& segment) {
  const Bounds box = object.field->grid.box();
  const Vec3 corner{std::max(std::abs(box.low.x), std::abs(box.high.x)),
                    std::max(std::abs(box.low.y), std::abs(box.high.y)),
                    std::max(std::abs(box.low.z), std::abs(box.high.z))};
  const Frame first = frame_at(object.frame, step, segment.begin),
              last = frame_at(object.frame, step, segment.end);
  const double reach = norm(corner) * std::max(first.scale, last.scale);
  const Vec3 from = segment.from - first.position, way = (segment.to - last.position) - from;
  const double length = norm(way);
  if (length == 0) return {0, 1};
  const double middle = -dot(from, way) / length / length;
  const double beside = norm(from + middle * way);
  const double half = std::sqrt(std::max(0.0, reach * reach - beside * beside)) / length;
  if (beside > reach) return {1, 0};
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

/// The turns by which, and into how many pieces at most, a path that is straight in the world is cut
/// where an object spins.
inline constexpr double straight_turn = 0.05, most_pieces = 1000;

/// Calls visit(from, to) in the object's coordinates for each piece of the segment, until a call
/// returns true; returns whether one did. Seen from an object that spins or grows a piece is
/// straight up to a quarter of a cell and 3e-4 of the distance from the object's origin; in at most
/// a thousand pieces.
template <class Visit>
bool any_piece(const Object& object, double step, const PathSegment& segment, const Visit& visit) {
  constexpr double most_bent = 0.25;
  const Frame& frame = object.frame;
  if (!frame.is_moving()) return visit(frame.to_object(segment.from), frame.to_object(segment.to));
  const auto [enters, leaves] = part_near(object, step, segment);
  if (!(enters <= leaves)) return false;
  const double lasts = segment.end - segment.begin, near = leaves - enters;
  const auto seen_at = [&](double part) {
    return frame_at(frame, step, segment.begin + part * lasts)
        .to_object(segment.from + part * (segment.to - segment.from));
  };
  const double way = norm(segment.to - segment.from - lasts * step * frame.velocity) * near;
  const double turn = norm(frame.angular_velocity) * step * lasts * near;
  const double growth = std::abs(frame.scale_rate) / frame.scale * step * lasts * near;
  const double cell = frame.scale * object.field->grid.cell;
  const double bends = std::sqrt((turn + growth) * way / (4 * most_bent * cell));
  const int n = 1 + static_cast<int>(std::min(std::max(turn / straight_turn, bends), most_pieces));
  Vec3 from = seen_at(enters);
  for (int i = 1; i <= n; ++i) {
    const Vec3 to = seen_at(enters + near * (static_cast<double>(i) / n));
    if (visit(from, to)) return true;
    from = to;
  }
  return false;
}

}  // namespace tess::dn
