// The voxels of a search, in numbers that mean the same in one thread (pairs.hpp) and on chares
// (collider.hpp). Where long thin objects are searched in pieces, the pieces are the objects.
#pragma once

#include "runtime/core/algorithm.hpp"

#include <cstdint>

namespace tess::collide {

/// The grid of a search; on chares that of all PEs. All are 0 if no grid was needed; but if no pair
/// is possible because all objects are of one model, each is an entry that is left out.
struct GridCounts {
  double voxel_size = 0;        ///< the longest edge of the smallest voxels
  std::uint64_t n_levels = 0;   ///< grids, for objects of different sizes; on chares those that
                                ///< the least and the greatest size of each octave allow
  std::uint64_t n_voxels = 0;   ///< that were searched
  std::uint64_t n_entries = 0;  ///< objects in voxels: an object counts in each that it touches
  /// Counts the entries in voxels that can have no pair: with one object, with none of the grid's
  /// own sizes, or with objects of one model (or of one of two sets) if pairs in it do not count.
  std::uint64_t n_left_out = 0;

  /// Adds the counts of two parts of a search.
  friend GridCounts operator+(const GridCounts& a, const GridCounts& b) {
    return {std::max(a.voxel_size, b.voxel_size), std::max(a.n_levels, b.n_levels),
            a.n_voxels + b.n_voxels, a.n_entries + b.n_entries, a.n_left_out + b.n_left_out};
  }
};

}  // namespace tess::collide
