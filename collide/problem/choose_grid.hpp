// Chooses the voxels for a search: the size that costs least (Lawlor and Kalé 2002, section 5.1,
// leave it to the user). Small voxels get each object many times; large ones compare many pairs. A
// sample of the objects says how many share a voxel at each size, on whatever surface or cluster
// they lie. The choice affects the speed only.
#pragma once

#include "collide/problem/problem.hpp"
#include "collide/problem/region_grid.hpp"

#include <vector>

namespace tess::collide::search {

template <std::size_t D>
struct Choice {
  CellAt<D> n_cells;
  double cost;  ///< expected, in nanoseconds
};

/// Where the voxels of a search are.
struct Place {
  bool on_chares = false;  ///< a voxel that has objects costs its messages
  double n_pes = 1;        ///< the last PE to finish has about one voxel more than the others
};

/// Keeps its memory from choice to choice.
template <class Real, std::size_t D>
class GridChooser {
 public:
  /// For a region that is as wide as the objects of `a` in it; with `as_points` as if the objects
  /// had no extents; as if there were `scale` objects for each.
  [[nodiscard]] Choice<D> choose(const Problem<Real, D>& problem, const Box<Real, D>& region,
                                 bool as_points = false, double scale = 1, const Place& place = {});
  /// The same with the sample of the last choose(), for the same problem, region and scale.
  [[nodiscard]] Choice<D> choose_again(const Problem<Real, D>& problem, const Box<Real, D>& region,
                                       bool as_points, double scale = 1,
                                       const Place& place = {}) const;

 private:
  struct Sample {
    std::uint64_t code;  // the bits of the cells, interleaved; then 1 for objects of b
    std::array<float, D> extent;
  };
  void take(const Box<Real, D>* boxes, std::span<const Entry> entries, const Box<Real, D>& region,
            Real widest, bool is_b, double scale);

  std::vector<Sample> samples_;
  double samples_a_ = 0, samples_b_ = 0;
};

/// The cells of the given size that cover the region; fewer if they were more than `most_cells`.
template <class Real, std::size_t D>
[[nodiscard]] CellAt<D> cells_of_size(const Box<Real, D>& region, double size, double most_cells);

}  // namespace tess::collide::search
