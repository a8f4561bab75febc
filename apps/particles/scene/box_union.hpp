// The surface of a union of boxes. Faces, or parts of them, that lie inside another box are left
// out: a field takes every triangle for surface, and one inside a solid makes what is deep inside
// look shallow. (A particle then slides on the ground right through the house that stands on it.)
#pragma once

#include "collide/dn_field/surface.hpp"

#include <vector>

namespace particles {

/// Closed, its triangles seen from outside counter-clockwise; each box is cut by the planes of all
/// faces. Throws tess::Error(bad_value) where that makes more than 1e8 cells.
[[nodiscard]] tess::dn::Surface union_of(const std::vector<tess::dn::Bounds>& boxes);

}  // namespace particles
