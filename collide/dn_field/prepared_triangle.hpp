// A triangle prepared for many distance queries: edges, inward directions and reciprocal lengths
// are precomputed and queries do not branch, so that a loop over points is vectorised. The distance
// is that to the face for a point above it, otherwise that to the nearest of the three edges.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <algorithm>
#include <array>

namespace tess::dn {

struct PreparedTriangle {
  std::array<Vec3, 3> corner, edge, inward;
  std::array<double, 3> per_edge2{};  ///< 1 / |edge|²; 0 for an edge without length
  Vec3 normal;                        ///< unit; zero for a triangle that counts as its edges
  double face_limit = 0;              ///< infinite if there is no face
};

/// A triangle thinner than 1e-9 of its longest edge counts as its edges: its normal would be
/// rounding, and the error of the distance is below that.
inline PreparedTriangle prepare(const std::array<Vec3, 3>& corners) {
  constexpr double thinnest = 1e-9;
  PreparedTriangle t;
  t.corner = corners;
  double longest2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    t.edge[i] = corners[(i + 1) % 3] - corners[i];
    const double length2 = dot(t.edge[i], t.edge[i]);
    t.per_edge2[i] = length2 > 0 && std::isfinite(1 / length2) ? 1 / length2 : 0;
    longest2 = std::max(longest2, length2);
  }
  const Vec3 area = cross(t.edge[0], -t.edge[2]);
  const bool has_face = norm(area) > thinnest * longest2;
  t.normal = has_face ? direction(area) : Vec3{};
  for (std::size_t i = 0; i < 3; ++i) t.inward[i] = cross(t.normal, t.edge[i]);
  t.face_limit = has_face ? 0 : HUGE_VAL;
  return t;
}

/// Squared distance from (x, y, z).
inline double distance2(const PreparedTriangle& t, double x, double y, double z) {
  std::array<double, 3> off{}, over{};
  double height = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 d{x - t.corner[i].x, y - t.corner[i].y, z - t.corner[i].z};
    double along = dot(d, t.edge[i]) * t.per_edge2[i];
    along = along > 0 ? along : 0;
    along = along < 1 ? along : 1;
    const Vec3 rest = d - along * t.edge[i];
    off[i] = dot(rest, rest);
    over[i] = dot(d, t.inward[i]);
    if (i == 0) height = dot(d, t.normal);
  }
  const double rim0 = off[0] < off[1] ? off[0] : off[1];
  const double rim = rim0 < off[2] ? rim0 : off[2];
  const double least0 = over[0] < over[1] ? over[0] : over[1];
  const double least = least0 < over[2] ? least0 : over[2];
  return least >= t.face_limit ? height * height : rim;
}

/// `p` minus the nearest point of the triangle; its squared length is distance2() to rounding.
inline Vec3 offset_from(const PreparedTriangle& t, Vec3 p) {
  Vec3 best;
  double best2 = HUGE_VAL, least = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 d = p - t.corner[i];
    const double along = std::clamp(dot(d, t.edge[i]) * t.per_edge2[i], 0.0, 1.0);
    const Vec3 rest = d - along * t.edge[i];
    if (dot(rest, rest) < best2) best2 = dot(rest, rest), best = rest;
    least = std::min(least, dot(d, t.inward[i]));
  }
  return least >= t.face_limit ? dot(p - t.corner[0], t.normal) * t.normal : best;
}

}  // namespace tess::dn
