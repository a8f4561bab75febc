// The thickness of a body behind its surface. A wall thinner than a voxel's diagonal may contain no
// voxel's centre: a one-sided field lets particles through there.
#pragma once

#include "collide/dn_field/bvh.hpp"

#include <vector>

namespace tess::dn {

/// The thickness along the inward normal at 1024 places spread evenly over the area: 0 where there
/// is no inside behind the place (an open surface), HUGE_VAL where it does not end. Lists are
/// sorted, the least first.
struct Walls {
  std::vector<double> opposite;  ///< up to a face with the opposite normal, to 30°
  std::vector<double> slanted;   ///< up to another face: at an edge, or of a rod of three sides
  /// The least of all, including the middles of up to 4096 triangles, for parts that the places
  /// miss.
  double least = HUGE_VAL;

  [[nodiscard]] double n_places() const {
    return static_cast<double>(opposite.size() + slanted.size());
  }
  /// The share of places that are thinner: up to opposite faces; up to any.
  [[nodiscard]] double share_thinner(double length) const;
  [[nodiscard]] double share_thinner_or_slanted(double length) const;
};

/// `tree`: of the surface. The lists are empty for a surface without area.
[[nodiscard]] Walls walls_of(const Surface& surface, const Bvh& tree);

}  // namespace tess::dn
