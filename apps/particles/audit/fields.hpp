// The field at one point, for the audit and the statistics. The step loop has its own look-ups.
#pragma once

#include "collide/dn_field/stepper.hpp"

namespace particles {

/// The signed distance of an object's field, flat or compressed, at a point in the object's
/// coordinates, interpolated between eight voxels; HUGE_VAL outside the grid. Its error is of second
/// order in the cell, off the medial axis.
[[nodiscard]] double distance_at(const tess::dn::Object& object, tess::dn::Vec3 p);

}  // namespace particles
