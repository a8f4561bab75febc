// What fields say of a point: what the audit and the statistics ask, one point at a time. The step
// loop has its own look-ups.
#pragma once

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/stepper.hpp"

namespace particles {

/// The signed distance at a point in the object's coordinates, interpolated between eight voxels;
/// HUGE_VAL outside the grid. Off by the square of the cell times the curvature, off the medial
/// axis.
[[nodiscard]] double distance_at(const tess::dn::Field& field, tess::dn::Vec3 p);
/// The same of an object's field, flat or compressed; its frame is not asked.
[[nodiscard]] double distance_at(const tess::dn::Object& object, tess::dn::Vec3 p);

}  // namespace particles
