// The serial step inside one voxel: all pairs (the oracle, and the fastest for few boxes) or sweep
// and prune along one axis (many boxes), behind one call; automatic chooses by count. Every method
// reports the same pairs, each once, and only those that are this voxel's (territory.hpp). A voxel
// of one model costs a scan. A PairSearch holds scratch memory and serves one thread.
#pragma once

#include "collide/serial/lanes.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace tess {

enum class SerialMethod { automatic, brute_force, sweep };

class PairSearch {
 public:
  explicit PairSearch(PairRules rules, SerialMethod method = SerialMethod::automatic)
      : rules_(rules), method_(method) {}

  /// Calls found(const Item&, const Item&) for each pair that voxel `cell` reports. `items` are all
  /// that it received, valid boxes that touch it.
  template <class Found>
  void for_each_pair(std::span<const Item> items,
                     const Cell& cell,
                     const VoxelGrid& grid,
                     Found&& found) {
    lanes_.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i)
      lanes_.set(i, items[i], cell, grid.cell_of(items[i].box.lo), static_cast<std::uint32_t>(i));
    search([&](std::uint32_t a, std::uint32_t b) { found(items[a], items[b]); });
  }

  /// The same for the items with these numbers.
  template <class Found>
  void for_each_pair(std::span<const Item> items,
                     std::span<const std::uint32_t> numbers,
                     const Cell& cell,
                     const VoxelGrid& grid,
                     Found&& found) {
    lanes_.resize(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const Item& item = items[numbers[i]];
      lanes_.set(i, item, cell, grid.cell_of(item.box.lo), numbers[i]);
    }
    search([&](std::uint32_t a, std::uint32_t b) { found(items[a], items[b]); });
  }

 private:
  static constexpr std::size_t kBruteForceUpTo = 64;

  template <class Found>
  void search(Found&& found) {
    if (lanes_.n < 2 || (rules_.within_model == WithinModel::skip && one_model())) return;
    const bool closed = rules_.touching == Touching::counts;
    if (rules_.within_model == WithinModel::skip)
      closed ? search<Touching::counts, WithinModel::skip>(found)
             : search<Touching::does_not_count, WithinModel::skip>(found);
    else
      closed ? search<Touching::counts, WithinModel::test>(found)
             : search<Touching::does_not_count, WithinModel::test>(found);
  }
  template <Touching touching, WithinModel within, class Found>
  void search(Found& found) {
    const bool sweep = method_ == SerialMethod::sweep ||
                       (method_ == SerialMethod::automatic && lanes_.n > kBruteForceUpTo);
    if (sweep) sort_along_widest_axis();
    const Lanes& lanes = sweep ? sorted_ : lanes_;
    const std::vector<double>& along = lanes.lo[axis_];
    for (std::size_t i = 0; i < lanes.n; ++i) {
      const Probe<touching, within> probe(lanes, i);
      const double end = lanes.hi[axis_][i];
      for (std::size_t j = i + 1; j < lanes.n; j += Lanes::width) {
        if (sweep && along[j] > end) break;  // all further boxes begin beyond this one
        for (std::uint32_t hits = probe.overlaps(j); hits != 0; hits &= hits - 1)
          found(lanes.source[i],
                lanes.source[j + static_cast<std::size_t>(std::countr_zero(hits))]);
      }
    }
  }
  [[nodiscard]] bool one_model() const noexcept {
    for (std::size_t i = 1; i < lanes_.n; ++i)
      if (lanes_.model[i] != lanes_.model[0]) return false;
    return true;
  }
  /// Copies lanes_ to sorted_ in order of their lower ends on the axis where these spread most.
  void sort_along_widest_axis();

  PairRules rules_;
  SerialMethod method_;
  Lanes lanes_;
  Lanes sorted_;
  std::size_t axis_ = 0;
  std::vector<std::pair<double, std::uint32_t>> order_;
};

}  // namespace tess
