// The audit of one particle and one object: whether a path leads through the surface.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/stepper.hpp"

namespace particles {

/// The signed distance of an object's field, flat or compressed, at a point in the object's
/// coordinates, interpolated between eight voxels; HUGE_VAL outside the grid. Its error is of
/// second order in the cell, off the medial axis. (The step loop has its own look-ups.)
[[nodiscard]] double distance_at(const tess::dn::Object& object, tess::dn::Vec3 p);

/// The depth below a surface, in cells, at which the field may still report the surface: two by
/// nearest look-up, which errs by up to half a diagonal where it stops a particle, and by as much
/// again in the voxel below; otherwise one.
[[nodiscard]] double greatest_depth(const tess::dn::Rules& rules);

/// An object in the audit.
struct Audited {
  const tess::dn::Object& object;
  const tess::dn::Bvh* triangles;  ///< of an open surface; otherwise not used
  double depth;                    ///< greatest_depth()
};

/// Whether a straight path in the coordinates of an object leads through its surface: through a
/// triangle of an open one; deeper than `depth` below that of a body, from a place that is not. A
/// body's walls that are thinner have no place so deep: passages there are not seen.
[[nodiscard]] bool leads_through(const Audited& audited, tess::dn::Vec3 from, tess::dn::Vec3 to);

}  // namespace particles
