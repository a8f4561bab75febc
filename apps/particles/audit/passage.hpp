// A particle's way through an object in one step, as the audit sees it.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/stepper.hpp"

#include <cstdint>

namespace particles {

/// What a particle has done so far.
struct Mark {
  enum What : std::uint8_t { nothing, inside, through } what = nothing;
  std::uint8_t looks = 0;    ///< inside, by a thin wall: which way that looks, to 30 degrees
  std::uint16_t object = 0;  ///< inside: of this one; numbers above 65535 begin again
};

/// How deep below a surface particles may come, in cells: for all that the field says they are on
/// it. Two by nearest look-up, which errs by up to half a diagonal in where it stops them and
/// leaves them as much deeper in a voxel that says less; else one.
[[nodiscard]] double greatest_depth(const tess::dn::Rules& rules);

/// An object as the audit sees it.
struct Audited {
  std::uint16_t number;
  const tess::dn::Object& object;  ///< its triangles: not of fields of one side without thin walls
  double depth;                    ///< greatest_depth()
};

/// The mark after a straight way in the coordinates of an object. A particle has been through a
/// surface
/// - of two sides: where it crosses a triangle;
/// - of one side: where it is deeper below it than it may come, and was not when it began;
/// - of one side with thin walls, which have no place so deep: where it leaves the body
///   through a triangle that looks the opposite way from the one it came in by, in this step or
///   before, or crosses an open sheet of it.
[[nodiscard]] Mark mark_after(Mark mark, const Audited& audited, tess::dn::Vec3 from,
                              tess::dn::Vec3 to);

}  // namespace particles
