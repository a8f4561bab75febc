// How a collider searches, and what it did.
#pragma once

#include "collide/box.hpp"
#include "collide/grid_counts.hpp"
#include "collide/hit.hpp"

#include <cstdint>

namespace tess::collide {

/// An item of a part of a search takes so many nanoseconds on a simulated machine with a fixed cost
/// per message. Pieces of long thin objects and kept pairs cost nothing.
struct SimulatedCosts {
  double gridding = 0;  ///< per object in a voxel: the voxel is found, and the object sorted there
  double search = 0;    ///< per object in a voxel that is searched
  double pair = 0;      ///< per pair that a voxel finds
  double reply = 0;     ///< per pair and owner that receives it
  double copy = 0;      ///< per box that is copied for another PE, and again where it is placed
  double record = 0;    ///< per voxel of a PE that the home of the voxel compares with other PEs'
};

/// The voxels, and the pairs that are hits.
struct ColliderOptions {
  Point origin{0, 0, 0};  ///< a lower corner of a voxel, if their size is given
  /// The edges of the smallest voxels. Zero means that each collision chooses them, and an origin,
  /// by expected cost.
  Point voxel_size{0, 0, 0};
  PairRules rules{};
  /// Bounds the pieces of objects with capsules. Infinite means that they are whole. Zero means
  /// that it is chosen with the size of the voxels; if that is given, objects are whole.
  double piece_length = 0;
  /// A length, for objects that move little from a collision to the next. If positive, a collision
  /// also finds pairs of boxes that are larger by it on each side, and keeps them. While the same
  /// objects are submitted, each within its larger box, the collisions after it test these pairs
  /// alone. The hits are the same. Objects have no capsules then.
  double slack = 0;
  InvalidBoxes invalid_boxes = InvalidBoxes::refuse;  ///< submit() does it, not submit_early()
  SimulatedCosts simulated_costs{};
};

/// What the last collision did, on all PEs.
struct CollisionStatistics {
  GridCounts grid;  ///< entries that are left out are not sent
  /// Counts pieces of long thin objects: one per whole object; 0 if objects have no capsules.
  std::uint64_t n_pieces = 0;
  std::uint64_t n_kept = 0;  ///< pairs of larger boxes that were tested (ColliderOptions::slack)
  bool searched = true;      ///< if not, these pairs are of a collision before, and all else is 0

  friend CollisionStatistics operator+(const CollisionStatistics& a, const CollisionStatistics& b) {
    return {a.grid + b.grid, a.n_pieces + b.n_pieces, a.n_kept + b.n_kept,
            a.searched || b.searched};
  }
};

}  // namespace tess::collide
