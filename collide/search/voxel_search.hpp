// Finds the pairs of a set of objects: sorts them into voxels, then compares the objects of each
// voxel. A voxel that has too many objects is a smaller problem of the same kind, and is divided
// again ("the voxel method again", Lawlor and Kalé 2002, section 2).
//
//     solve:  few objects -> compare them
//             otherwise   -> choose a grid, sort the objects into its cells, solve every cell
//
// A VoxelSearch keeps its memory from search to search. Each thread needs its own.
#pragma once

#include "collide/pairs.hpp"
#include "collide/problem/choose_grid.hpp"
#include "collide/problem/scratch.hpp"
#include "collide/search/lanes.hpp"
#include "collide/search/slices.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace tess::collide::search {

template <class Real, std::size_t D>
class VoxelSearch {
 public:
  /// The options' models belong to the boxes of `a`; they are compared pair by pair.
  VoxelSearch(const PairOptions& options, bool by_model, detail::PairSink sink)
      : options_(options), by_model_(by_model), pairs_(sink) {}

  /// For a next search; the memory is kept.
  void restart(const PairOptions& options, bool by_model, detail::PairSink sink) {
    options_ = options;
    by_model_ = by_model;
    pairs_ = PairBuffer(sink, std::move(pairs_));
    statistics_ = {};
  }
  /// Finds the pairs of a problem. `region` contains the objects of `a`. With `swapped` the sink is
  /// told that `a` is the second set. `choice` is that of chooser(), if it is known. Returns false,
  /// without a pair, if more than the greatest number of entries were needed.
  [[nodiscard]] bool solve(const Problem<Real, D>& problem, const Box<Real, D>& region,
                           bool swapped, const std::optional<Choice<D>>& choice = {});
  void set_most_entries(std::size_t n) noexcept { most_entries_ = n; }

  [[nodiscard]] PairStatistics& statistics() noexcept { return statistics_; }
  [[nodiscard]] GridChooser<Real, D>& chooser() noexcept { return chooser_; }

 private:
  using TheBox = Box<Real, D>;
  using TheProblem = Problem<Real, D>;

  /// Per cell: the number of objects of each set, then where the next one goes.
  struct Counts {
    std::uint32_t a = 0, b = 0;
  };
  struct Voxel {
    std::uint32_t cell, begin, n_a, n_b;
  };
  /// The memory of one level of the recursion.
  struct Level {
    std::vector<Counts> cells;
    std::vector<std::uint64_t> models;  // per cell: 0, model + 1, or several
    Scratch<std::uint32_t> codes;       // per object: RegionGrid::code()
    Scratch<Entry> sorted;              // by voxel
    std::vector<Voxel> voxels;
  };

  bool solve(const TheProblem& problem, const TheBox& region, std::size_t depth,
             const std::optional<Choice<D>>& choice);
  [[nodiscard]] CellAt<D> choose(const TheProblem& problem, const TheBox& region,
                                 std::size_t depth);
  bool sort_into_voxels(const TheProblem& problem, const TheBox& of_a,
                        const RegionGrid<Real, D>& grid, Level& level);
  template <bool is_b, bool again, class Take>
  static bool spread(const TheProblem& problem, const TheBox& of_a, const RegionGrid<Real, D>& grid,
                     Level& level, const Take& take);
  void note_models(Level& level, const std::uint32_t* cell_of, const std::uint32_t* entry_of,
                   std::size_t n);
  void compare(const TheProblem& problem);
  template <Touching touching, bool by_model>
  void compare_as(const TheProblem& problem);
  template <Touching touching, bool by_model>
  void within(const TheProblem& problem);
  template <Touching touching, bool by_model>
  void across(const TheProblem& problem);
  template <bool by_model>
  void fill(const TheBox* boxes, std::span<const Entry> entries, bool in_slices);
  [[nodiscard]] bool sweeps(std::size_t n) const noexcept;

  PairOptions options_;
  bool by_model_;
  bool swapped_ = false;
  std::size_t most_entries_ = ~std::size_t{0};  // of the first grid
  PairStatistics statistics_;
  GridChooser<Real, D> chooser_;
  Lanes<Real, D> lanes_;
  std::deque<Level> levels_;
  Slices<Real, D> slices_;
  PairBuffer pairs_;
};

}  // namespace tess::collide::search
