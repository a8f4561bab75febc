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

/// The mark after a straight way in the coordinates of the object of that number. A particle has
/// been through a surface
/// - of two sides: where it crosses a triangle;
/// - of one side: where it is more than a cell below it, and was not when it began. Nearer to the
///   surface the field itself is not sure;
/// - of one side with thin walls, which have no place a cell below: where it leaves the body
///   through a triangle that looks the opposite way from the one it came in by, in this step or
///   before, or crosses an open sheet of it.
/// `triangles`: null for fields of one side without thin walls.
[[nodiscard]] Mark mark_after(Mark mark,
                              std::uint16_t number,
                              const tess::dn::Object& object,
                              const tess::dn::Bvh* triangles,
                              tess::dn::Vec3 from,
                              tess::dn::Vec3 to);

}  // namespace particles
