// A triangle mesh as it comes from a file: what a distance/normal field is built from. It may have
// holes, flipped triangles and self-intersections; it may not be empty, hold NaN, or name vertices
// it has not got.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tess::dn {

struct Surface {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside

  [[nodiscard]] std::array<Vec3, 3> corners(std::size_t triangle) const {
    const auto& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

/// The box around all vertices that a triangle uses.
[[nodiscard]] Bounds bounds(const Surface& surface);

/// Throws Error(bad_mesh) for an empty surface, one without area, an index out of range or a vertex
/// that is not finite.
void validate(const Surface& surface);

/// A hash of all vertices and triangles, in their order; never 0.
[[nodiscard]] std::uint64_t fingerprint(const Surface& surface);

/// Where a surface ends: an edge that runs `surplus` times more often from `from` to `to` than
/// back.
struct RimEdge {
  std::uint32_t from = 0, to = 0;
  int surplus = 0;  ///< positive
};

/// All edges that are not met by as many opposite ones: the rims of holes, and those of flipped
/// triangles. Costs the number of triangles.
[[nodiscard]] std::vector<RimEdge> rim(const Surface& surface);

/// Whether every directed edge is met by as many opposite ones: then the winding number is an
/// integer off the surface.
[[nodiscard]] inline bool is_closed(const Surface& surface) {
  return rim(surface).empty();
}

/// The share of edges between two triangles that run along it the same way, so that one of them is
/// flipped. 0 where no two triangles meet.
[[nodiscard]] double disagreeing_share(const Surface& surface);

/// Merges vertices of bit-equal position, so that a triangle soup whose seams agree counts as
/// closed.
[[nodiscard]] Surface welded(const Surface& surface);

/// Reads vertices and faces of a Wavefront OBJ file; polygons become fans, texture and normal
/// indices are ignored. Throws Error(bad_file) naming file and line.
[[nodiscard]] Surface read_obj(const std::string& path);

}  // namespace tess::dn
