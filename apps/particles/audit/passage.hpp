// The audit of one particle and one object: whether a path leads through the surface.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/stepper.hpp"

#include <cstdint>

namespace particles {

/// The signed distance of an object's field, flat or compressed, at a point in the object's
/// coordinates, interpolated between eight voxels; HUGE_VAL outside the grid. Its error is of
/// second order in the cell, off the medial axis. (The step loop has its own look-ups.)
[[nodiscard]] double distance_at(const tess::dn::Object& object, tess::dn::Vec3 p);

/// The state of a particle in the audit.
struct Mark {
  enum What : std::uint8_t { nothing, inside, through } what = nothing;
  std::uint8_t looks = 0;    ///< inside: direction of the wall through which it came, to 30 degrees
  std::uint16_t object = 0;  ///< inside: number of the object, modulo 65536
};

/// The depth below a surface, in cells, at which the field may still report the surface: two by
/// nearest look-up, which errs by up to half a diagonal where it stops a particle, and by as much
/// again in the voxel below; otherwise one.
[[nodiscard]] double greatest_depth(const tess::dn::Rules& rules);

/// An object in the audit.
struct Audited {
  std::uint16_t number;
  const tess::dn::Object&
      object;    ///< with its triangles, except one-sided bodies without thin walls
  double depth;  ///< greatest_depth()
};

/// The mark after a straight path in the coordinates of an object. A particle has been through a
/// surface
/// - of two sides: if it crosses a triangle;
/// - of one side: if it is deeper below the surface than `depth`, and was not at the begin;
/// - of one side with thin walls, which have no place so deep: if it leaves the body through a
///   triangle of opposite direction to the one by which it entered, in this step or before, or
///   crosses an open sheet of the body.
[[nodiscard]] Mark mark_after(Mark mark, const Audited& audited, tess::dn::Vec3 from,
                              tess::dn::Vec3 to);

}  // namespace particles
