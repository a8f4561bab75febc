// What fields say of a point: what the audit and the statistics ask, one point at a time. The step
// loop has its own look-ups.
#pragma once

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/stepper.hpp"
#include "collide/dn_field/surface.hpp"

namespace particles {

/// The signed distance at a point in the object's coordinates, interpolated between eight voxels;
/// HUGE_VAL outside the grid. Off by the square of the cell times the curvature, off the medial
/// axis.
[[nodiscard]] double distance_at(const tess::dn::Field& field, tess::dn::Vec3 p);
/// The same of an object's field, flat or compressed; its frame is not asked.
[[nodiscard]] double distance_at(const tess::dn::Object& object, tess::dn::Vec3 p);

/// A particle's way through the surface of an object in one step. It counts where the way reaches
/// more than a cell below the surface and began above it (fields of one side), or crosses a
/// triangle (of two sides). Nearer to the surface the field itself is not sure.
[[nodiscard]] bool passes_surface(const tess::dn::Object& object,
                                  const tess::dn::Surface& surface,
                                  tess::dn::Vec3 from,
                                  tess::dn::Vec3 to);

}  // namespace particles
