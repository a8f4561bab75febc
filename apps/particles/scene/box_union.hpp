// The surface of a union of boxes. Faces, or parts of them, that lie inside another box are left
// out: a field takes every triangle for surface, and a triangle inside a solid makes points deep
// inside look shallow. (A particle then slides on the ground through the house that stands on it.)
#pragma once

#include "collide/dn_field/surface.hpp"

#include <vector>

namespace particles {

/// Closed, its triangles counter-clockwise seen from outside; the planes of all faces cut each box.
/// Throws tess::Error(bad_value) where they make more than 1e8 cells.
[[nodiscard]] tess::dn::Surface union_of(const std::vector<tess::dn::Bounds>& boxes);

}  // namespace particles
