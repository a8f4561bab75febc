// A picture of a result for a web browser: a cut through the target across its shortest side,
// coloured by the field, and beside it by the error.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"

#include <string>

namespace m2m_transfer {

/// Draws the first field of the last pair's target as SVG: the value, and |value - truth|. Each
/// tetrahedron that the plane intersects is a polygon with one colour. Vertices outside have the
/// values of the policy.
[[nodiscard]] std::string picture(const Problem& problem);

}  // namespace m2m_transfer
