// A picture of a result: a cut through the target, across its shortest side, coloured by a field
// and by its error. What a browser shows where no ParaView is at hand.
#pragma once

#include "apps/m2m_transfer/problem.hpp"

#include <string>

namespace tess::m2m {

/// The first field of a problem that was measured, as SVG: the value, and beside it |value -
/// truth|. Each tetrahedron that the plane meets is one polygon of one colour. Vertices outside
/// count with what the policy gave.
[[nodiscard]] std::string picture(const Problem& problem);

}  // namespace tess::m2m
