// A triangle mesh as read from a file, from which a distance/normal field is built. It may have
// holes, flipped triangles and self-intersections; it must not be empty, hold NaN, or refer to
// missing vertices.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace tess::dn {

struct Surface {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  /// How often a file has what is skipped, or is cut in doubt: "polygons that are not flat".
  std::map<std::string, std::uint64_t> remarks{};

  [[nodiscard]] std::array<Vec3, 3> corners(std::size_t triangle) const {
    const auto& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

/// Calls visit(Vec3) for each corner of each triangle: for a vertex as often as triangles use it,
/// and not for others, which a mesh may hold anywhere.
template <class Visit>
void each_corner(const Surface& surface, const Visit& visit) {
  for (const auto& triangle : surface.triangles)
    for (const auto v : triangle) visit(surface.vertices[v]);
}

/// The box around all vertices that a triangle uses.
[[nodiscard]] Bounds bounds(const Surface& surface);

/// Throws Error(bad_mesh) for an empty surface, one without area, an index out of range or a vertex
/// that is not finite.
void validate(const Surface& surface);

/// A hash of all vertices and triangles, in their order; never 0.
[[nodiscard]] std::uint64_t fingerprint(const Surface& surface);

/// Whether every directed edge has as many opposite ones, by a hash of 64 bits. Then the winding
/// number off the surface is an integer.
[[nodiscard]] bool is_closed(const Surface& surface);

/// Merges vertices with bit-equal positions: a triangle soup with equal seams becomes closed.
[[nodiscard]] Surface welded(const Surface& surface);

/// The surface of a body, before a one-sided field is built from it: welded unless it is closed,
/// and turned as a whole if it has no rim and its triangles face inwards. Parts that disagree with
/// each other stay as they are; the inside is where the winding number exceeds 1/2.
[[nodiscard]] Surface outward(const Surface& surface);

struct SurfacePoint {
  Vec3 at;
  Vec3 normal;  ///< unit; zero on a triangle without area
  std::uint32_t triangle = 0;
};

/// The sum of the triangles' areas up to each, inclusive.
[[nodiscard]] std::vector<double> area_sums(const Surface& surface);

/// A point by three numbers within [0, 1): the first selects a triangle by area, the others a point
/// of it. Evenly distributed numbers give points evenly distributed over the area. `sums`:
/// area_sums(surface), not empty.
[[nodiscard]] SurfacePoint point_on(const Surface& surface, const std::vector<double>& sums,
                                    double first, double second, double third);

/// Appends the triangles of a polygon with these corners. If the fan from the first corner covers
/// the polygon, as it does a convex one, it is taken; otherwise ears are cut off. A remark counts
/// polygons that are not flat, of which the projection is cut, and those that cross themselves,
/// which become fans. Corners may be missing or not finite, as validate() says.
void add_polygon(Surface& surface, std::span<const std::uint32_t> corners);

/// "polygons that are not flat: 2, skipped l: 3"; empty if there are none.
[[nodiscard]] std::string remarks_text(const Surface& surface);

/// Reads vertices and faces of a Wavefront OBJ file; texture and normal indices are ignored, other
/// elements are skipped with a remark. Coordinates and areas are not checked: validate() does.
/// Throws Error(bad_file) naming file and line.
[[nodiscard]] Surface read_obj(const std::string& path);

}  // namespace tess::dn
