// Motions on the command line:
//
//     B:rotate(0,0,1,5deg)          by 5 degrees about the axis (0, 0, 1) through the middle of
//                                   mesh B's bounding box; without "deg" in radians
//     B:rotate(0,0,1,5deg,0,0,0)    about the axis through the point (0, 0, 0)
//     B:translate(0.1,0,0)
//
// Without a mesh the first pair's target moves.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "m2m/rigid_motion.hpp"

#include <string>
#include <vector>

namespace m2m_transfer {

/// A motion before every step but the first.
struct StepMotion {
  std::size_t mesh = 0;
  RigidMotion motion{};
  bool about_middle = false;  ///< the centre is the middle of the bounding box of the mesh
};

/// Throws Error (bad_argument) with the text and the grammar.
[[nodiscard]] StepMotion parse_motion(const std::string& text,
                                      const std::vector<std::string>& meshes,
                                      std::size_t default_mesh);

/// Puts the centre of a motion about the middle of this box there.
void set_centre(StepMotion& motion, const Aabb& bounds);

/// After a motion of a mesh: its middle, which is a centre of these, has moved with it.
void move_centres(std::vector<StepMotion>& motions, const RigidMotion& made);

/// What moves points back, one after the other: the opposites of motions in the order in which they
/// were made, from the last one on.
[[nodiscard]] std::vector<RigidMotion> opposite(const std::vector<RigidMotion>& motions);

}  // namespace m2m_transfer
