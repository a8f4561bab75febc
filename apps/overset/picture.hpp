// Pictures of overset meshes for a web browser: a cut through all, across z, or along the first plane
// of symmetry's normal.
#pragma once

#include "apps/overset/assembly.hpp"

#include <string>

namespace overset {

enum class Moment { before, after };

/// SVG. Each tetrahedron that the plane through the middle of the first wall meets is a polygon.
/// Before: all of the meshes. After: those without a hole; fringe tetrahedra are shaded, orphans are red.
[[nodiscard]] std::string picture(const Problem& problem, const Assembly& assembly, Moment moment);

}  // namespace overset
