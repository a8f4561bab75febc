// The paper's two constructions, behind a door of their own: the headers of construction and those
// of the rules have a type Sweep each.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/surface.hpp"

namespace particles {

/// The field of `surface` by the normals or the potential method, its blur chosen from the
/// thickness. Throws tess::Error where the method fails: a two-sided or very thin object by
/// normals.
[[nodiscard]] tess::dn::Field blurred_field(const tess::dn::Surface& surface,
                                            const tess::dn::Grid& grid,
                                            tess::dn::Method method,
                                            tess::dn::Sides sides,
                                            double thickness);

}  // namespace particles
