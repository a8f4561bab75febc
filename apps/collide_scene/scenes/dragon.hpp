// A closed curved surface of many small triangles without a file, in the place of the scanned
// dragon of the paper (Lawlor and Kalé 2002, section 4.2): a bumpy tube around a trefoil knot.
#pragma once

#include "apps/collide_scene/scenes/scene.hpp"

namespace collide_scene {

/// At most n triangles, as many as whole rings of a closed tube have; at least 24. About 6 units
/// across, one model, without self-intersection, each edge in two triangles.
[[nodiscard]] Scene dragon(std::uint64_t n);

}  // namespace collide_scene
