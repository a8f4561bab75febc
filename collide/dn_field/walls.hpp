// How thick a body is behind its surface. A wall thinner than a voxel's diagonal may hold no voxel
// that knows of it: a one-sided field lets particles through there.
#pragma once

#include "collide/dn_field/bvh.hpp"

#include <vector>

namespace tess::dn {

/// How far along the inward normal the body ends, at 1024 places spread evenly over its area: 0
/// where nothing is inside behind the place, as of a flat open sheet; HUGE_VAL where it does not
/// end. Each list begins with the least.
struct Walls {
  std::vector<double> opposite;  ///< ending at a face that looks the opposite way, to 30°
  std::vector<double> slanted;   ///< at another: of an edge, but also of a rod of three sides
  /// The least of all, also in the middle of the triangles, 4096 at most: parts too small for the
  /// places.
  double least = HUGE_VAL;

  [[nodiscard]] double n_places() const {
    return static_cast<double>(opposite.size() + slanted.size());
  }
  /// The share of places that are thinner, by faces that look the opposite way; by any.
  [[nodiscard]] double share_thinner(double length) const;
  [[nodiscard]] double share_thinner_or_slanted(double length) const;
};

/// `tree`: of the surface. Nothing of a surface without area.
[[nodiscard]] Walls walls_of(const Surface& surface, const Bvh& tree);

}  // namespace tess::dn
