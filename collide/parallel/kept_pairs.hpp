// Pairs of objects whose boxes overlap when they are larger by a slack on each side, as neighbour
// lists have them (Verlet 1967). While every object stays within its larger box, all pairs of boxes
// that overlap are among these: a collision tests them, and grids, sorts and searches nothing.
//
// A PE keeps the pairs of its own objects with one another, and with those of each other PE that it
// was given. Of these it has a copy each, without their boxes:
//
//     PE 0   3 with 8, 4 with 8                     within the PE, by positions in its list
//            5 with 0, 6 with 1, 6 with 0           with PE 2, by positions in the copies
//            copies of PE 2's objects 17 and 40
//     PE 2   PE 0 needs 17 and 40                   whose boxes it sends before each test
#pragma once

#include "collide/hit_receivers.hpp"
#include "collide/parallel/hit_sorter.hpp"
#include "collide/parallel/object_list.hpp"
#include "collide/parallel/plan.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

namespace tess::collide {

/// The box with all faces further out by `slack`, which is not negative. It contains the box,
/// whatever is rounded.
[[nodiscard]] Aabb larger_box(const Aabb& box, double slack) noexcept;

/// The objects of this PE as the PE's own, numbered by their positions, with larger boxes: what is
/// searched for pairs to keep.
[[nodiscard]] ObjectList larger_objects(const ObjectList& objects, double slack, PeId pe);

/// True if the sample of larger objects says that they have many times the pairs that are kept:
/// these are not searched, which would take long.
[[nodiscard]] bool are_far_too_many(const Summary& larger, const PairRules& rules,
                                    std::int32_t n_pes);

class KeptPairs {
 public:
  /// Of the collision that finds them, on this PE.
  KeptPairs(std::uint64_t step, PeId pe) : step_(step), pe_(pe) {}
  [[nodiscard]] std::uint64_t step() const noexcept { return step_; }

  /// Pairs of larger_objects(). Beyond so many per object of the PE none is kept.
  void add(Hits&& found, std::size_t n_objects);
  [[nodiscard]] bool are_too_many() const noexcept { return too_many_; }

  /// Calls ask(pe, positions) for each other PE whose objects are in pairs, once.
  void ask_for_others(const std::function<void(std::int32_t, std::span<const std::uint32_t>)>& ask);
  /// The number of these PEs.
  [[nodiscard]] std::size_t n_others() const noexcept {
    return with_.size() - with_.count(pe_.value);
  }
  /// What was asked for.
  void set_copies(std::int32_t of, ObjectList copies) { with_.at(of).copies = std::move(copies); }
  [[nodiscard]] const ObjectList& copies(std::int32_t of) const { return with_.at(of).copies; }

  /// The positions that a PE asked for.
  void set_needed(std::int32_t by, std::span<const std::uint32_t> positions) {
    needed_[by].assign(positions.begin(), positions.end());
  }
  [[nodiscard]] const std::map<std::int32_t, std::vector<std::uint32_t>>& needed() const {
    return needed_;
  }

  /// The objects of which these are the pairs, as they were searched.
  void set_objects(ObjectList objects, double slack);
  /// True if `now` has the same objects, each within its larger box.
  [[nodiscard]] bool hold_for(const ObjectList& now) const;

  /// By PE, in the order of the positions that it was asked for.
  using Boxes = std::map<std::int32_t, std::vector<Aabb>>;
  /// How far a test has come.
  struct Progress {
    std::int32_t pe = 0;
    std::size_t n_lists = 0;  // of pairs with this PE
    std::uint64_t n_tested = 0;
  };
  /// Tests some of the pairs, and sends the hits; false if there are no more.
  bool test(Progress& progress, const ObjectList& now, const Boxes& of_others, Touching touching,
            const HitReceivers& to) const;

 private:
  struct With {
    std::vector<std::vector<LocalPair>> lists;  // of pairs, as they arrived
    ObjectList copies;                          // empty for the own PE
  };

  std::uint64_t step_;
  PeId pe_;
  std::map<std::int32_t, With> with_;
  std::size_t n_pairs_ = 0;
  bool too_many_ = false;
  std::map<std::int32_t, std::vector<std::uint32_t>> needed_;
  ObjectList objects_;  // with larger boxes
};

}  // namespace tess::collide
