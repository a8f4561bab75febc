// Chooses the voxels for a search: the size that costs least (Lawlor and Kalé 2002, section 5.1,
// leave it to the user). Small voxels get each object many times; large ones compare many pairs. A
// sample of the objects says how many share a voxel at each size, on whatever surface or cluster
// they lie. The choice affects the speed only.
#pragma once

#include "collide/search/entry.hpp"
#include "collide/search/region_grid.hpp"

#include <span>
#include <vector>

namespace tess::collide::search {

/// The objects of a search: pairs of `a` with `b`, and with `within_a` also pairs within `a`. The
/// entries refer to boxes_a and boxes_b.
template <class Real, std::size_t D>
struct Problem {
  const Box<Real, D>* boxes_a;
  const Box<Real, D>* boxes_b;
  std::span<const Entry> a;
  std::span<const Entry> b;
  bool within_a;

  [[nodiscard]] double n_comparisons() const noexcept {
    const auto n_a = static_cast<double>(a.size()), n_b = static_cast<double>(b.size());
    return n_a * ((within_a ? n_a / 2 : 0) + n_b);
  }
};

/// The bounds of the objects' boxes.
template <class Real, std::size_t D>
[[nodiscard]] Box<Real, D> bounds_of(const Box<Real, D>* boxes, std::span<const Entry> entries) {
  Box<Real, D> bounds = no_box<Real, D>();
  for (const Entry entry : entries) bounds = merged(bounds, boxes[object_of(entry)]);
  return bounds;
}

/// A position in a sample that does not follow a period of the input. That of sample 0 is the first
/// object, unless a seed is given.
[[nodiscard]] inline std::size_t scattered(std::size_t i, std::size_t n_samples, std::size_t n,
                                           std::size_t seed = 0) {
  const std::size_t begin = i * n / n_samples, end = (i + 1) * n / n_samples;
  return begin + ((i + seed) * 0x9E3779B97F4A7C15U >> 32) % (end - begin);
}

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
                                       bool as_points, double scale, const Place& place) const;

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
