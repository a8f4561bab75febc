// A particle's way through an object in one step, as the audit sees it.
#pragma once

#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/stepper.hpp"

#include <cstdint>

namespace particles {

/// What a particle has done so far: nothing, been through a surface, or, above those, entered a
/// body through a wall; then the mark says which way the wall looks.
using Mark = std::uint8_t;
inline constexpr Mark unmarked = 0, tunnelled = 1;

/// The mark after a straight way in the object's coordinates. A particle has been through a surface
/// - of two sides: where it crosses a triangle;
/// - of one side: where it is more than a cell below it, and was not when it began. Nearer to the
///   surface the field itself is not sure;
/// - of one side with thin walls, which have no place a cell below: where it leaves the body
///   through a triangle that looks the opposite way from the one it came in by, in this step or
///   before.
/// `triangles`: null for fields of one side without thin walls.
[[nodiscard]] Mark mark_after(Mark mark,
                              const tess::dn::Object& object,
                              const tess::dn::Bvh* triangles,
                              tess::dn::Vec3 from,
                              tess::dn::Vec3 to);

}  // namespace particles
