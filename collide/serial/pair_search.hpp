// Finds the pairs within one voxel, by one of three methods: all pairs (the oracle), a sweep over
// slices along one axis, or recursive coordinate bisection (Lawlor and Kalé 2002, section 3.2).
// Every method reports the same pairs, each once, and only those that the voxel is responsible for
// (territory.hpp).
//
// If there are two models and pairs within a model do not count, as in a mesh transfer, the sweep
// is bipartite: it compares each box of one model with the boxes of the other model in lanes, and
// never looks at a pair within a model. A voxel with a single model costs one pass over its items.
// A PairSearch holds scratch memory, so each thread needs its own.
#pragma once

#include "collide/serial/buckets.hpp"
#include "collide/serial/lanes.hpp"
#include "collide/serial/voxel_grid.hpp"

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tess::collide {

/// How the pairs of one voxel are found. `automatic` chooses by the number of objects and models.
enum class SerialMethod { automatic, brute_force, sweep, bisection };

}  // namespace tess::collide

namespace tess::collide::serial {

class PairSearch {
 public:
  explicit PairSearch(PairRules rules, SerialMethod method = SerialMethod::automatic)
      : rules_(rules), method_(method) {}

  /// Calls found(const Item&, const Item&) per pair that the voxel `cell` reports. `items`: all
  /// items of the voxel; their boxes are valid and touch it.
  template <class Found>
  void for_each_pair(std::span<const Item> items, const Cell& cell, const VoxelGrid& grid,
                     Found&& found) {
    const bool closed = rules_.touching == Touching::counts;
    if (rules_.within_model == WithinModel::skip)
      closed ? search<Touching::counts, WithinModel::skip>(items, cell, grid, found)
             : search<Touching::does_not_count, WithinModel::skip>(items, cell, grid, found);
    else
      closed ? search<Touching::counts, WithinModel::test>(items, cell, grid, found)
             : search<Touching::does_not_count, WithinModel::test>(items, cell, grid, found);
  }

  /// The same, for the items with these indices.
  template <class Found>
  void for_each_pair(std::span<const Item> items, std::span<const std::uint32_t> numbers,
                     const Cell& cell, const VoxelGrid& grid, Found&& found) {
    gathered_.clear();
    for (const std::uint32_t i : numbers) gathered_.push_back(items[i]);
    for_each_pair(gathered_, cell, grid, [&](const Item& a, const Item& b) {
      found(items[numbers[static_cast<std::size_t>(&a - gathered_.data())]],
            items[numbers[static_cast<std::size_t>(&b - gathered_.data())]]);
    });
  }

 private:
  static constexpr std::size_t brute_force_up_to = 16;

  /// An item of a node of the bisection: its index, and the axes on which its lower corner lies
  /// below the node.
  using Entry = std::pair<std::uint32_t, std::uint32_t>;
  struct Models {
    int n = 0;  ///< 0: not counted; 3: more than two
    ModelId second{};
    std::size_t n_second = 0;
  };

  template <Touching touching, WithinModel within, class Found>
  void search(std::span<const Item> items, const Cell& cell, const VoxelGrid& grid, Found& found) {
    if (items.size() < 2) return;
    const Models models = within == WithinModel::skip ? count_models(items) : Models{};
    if (within == WithinModel::skip && models.n == 1) return;
    set_below(items, cell, grid);
    const auto report = [&](std::uint32_t i, std::uint32_t j) { found(items[i], items[j]); };
    const bool few = items.size() <= brute_force_up_to;
    if (method_ == SerialMethod::bisection) {
      bisect<touching, within>(items, whole(items), report);
    } else if (method_ == SerialMethod::brute_force ||
               (method_ == SerialMethod::automatic && few)) {
      fill(items, whole(items));
      all_pairs<touching, within>(report);
    } else if (within == WithinModel::skip && models.n == 2) {
      sweep_two_models<touching>(items, models, report);
    } else {
      sweep<touching, within>(items, report);
    }
  }

  /// Compares each box with all later ones.
  template <Touching touching, WithinModel within, class Report>
  void all_pairs(Report& report) {
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      compare(Probe<touching, within>(lanes_, i), lanes_.source[i], i + 1, lanes_.size(), report);
  }

  /// Compares each box with the later ones in the order of slices, up to its upper end.
  template <Touching touching, WithinModel within, class Report>
  void sweep(std::span<const Item> items, Report& report) {
    const Slices slices(items, items.size());
    fill_by_slice(
        items, [](const Item&) { return true; }, slices);
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      const std::size_t end = order_.end(slices.of(lanes_.hi[slices.axis()][i]));
      compare(Probe<touching, within>(lanes_, i), lanes_.source[i], i + 1, end, report);
    }
  }

  /// Compares each box of one model with the range of boxes of the other model that may reach it.
  template <Touching touching, class Report>
  void sweep_two_models(std::span<const Item> items, const Models& models, Report& report) {
    const Slices slices(items, models.n_second);
    const auto in_lanes = [&](const Item& item) { return item.id.model == models.second; };
    fill_by_slice(items, in_lanes, slices);
    for (std::uint32_t i = 0; i < items.size(); ++i) {
      if (in_lanes(items[i])) continue;
      const std::size_t first = order_.first(slices.of_lo(items[i]));
      const std::size_t end = order_.end(slices.of_hi(items[i]));
      // The models differ, so the probe need not compare them.
      compare(Probe<touching, WithinModel::test>(items[i], below_[i]), i, first, end, report);
    }
  }

  /// Splits the node by a plane through the median of the lower corners. A box that crosses the
  /// plane goes to both halves. A pair belongs to the half that contains the greater of its lower
  /// corners, as with voxels.
  template <Touching touching, WithinModel within, class Report>
  void bisect(std::span<const Item> items, const std::vector<Entry>& node, Report& report) {
    if (const auto split = halves(items, node)) {
      for (const std::vector<Entry>& half : *split) bisect<touching, within>(items, half, report);
    } else {
      fill(items, node);
      all_pairs<touching, within>(report);
    }
  }

  /// Finds the partners of a probe among the boxes from first to end, without a branch per hit,
  /// then reports them.
  template <class Probe, class Report>
  void compare(const Probe& probe, std::uint32_t number, std::size_t first, std::size_t end,
               Report& report) {
    std::uint32_t* const begin = partners_.data();
    std::uint32_t* next = begin;
    for (std::size_t j = first; j < end; j += Lanes::width) {
      const std::uint32_t hits = probe.overlaps(lanes_, j) & first_lanes(end - j);
      next = lanes_.copy_sources(j, hits, next);
    }
    for (const std::uint32_t* partner = begin; partner != next; ++partner) report(number, *partner);
  }
  [[nodiscard]] static std::uint32_t first_lanes(std::size_t n) noexcept {
    return n < Lanes::width ? (1u << n) - 1 : 0xFFu;
  }
  void resize_lanes(std::size_t n) {
    lanes_.resize(n);
    if (partners_.size() < n + Lanes::width) partners_.resize(2 * n + Lanes::width);
  }

  [[nodiscard]] static Models count_models(std::span<const Item> items) noexcept;

  /// Fills below_ with axes_below() of each item.
  void set_below(std::span<const Item> items, const Cell& cell, const VoxelGrid& grid);
  [[nodiscard]] std::vector<Entry> whole(std::span<const Item> items) const;
  void fill(std::span<const Item> items, const std::vector<Entry>& node);
  /// The two halves of a node; empty if a split is not worthwhile.
  [[nodiscard]] static std::optional<std::array<std::vector<Entry>, 2>> halves(
      std::span<const Item> items, const std::vector<Entry>& node);
  template <class In>
  void fill_by_slice(std::span<const Item> items, const In& in, const Slices& slices) {
    order_.start(slices);
    std::size_t n = 0;
    for (const Item& item : items) {
      if (!in(item)) continue;
      order_.count(slices.of_lo(item), slices.of_hi(item));
      ++n;
    }
    order_.finish_count();
    resize_lanes(n);
    for (std::uint32_t i = 0; i < items.size(); ++i)
      if (in(items[i])) lanes_.set(order_.place(slices.of_lo(items[i])), items[i], below_[i], i);
  }

  PairRules rules_;
  SerialMethod method_;
  Lanes lanes_;
  BucketOrder order_;
  std::vector<std::uint32_t> below_;
  std::vector<std::uint32_t> partners_;  // of the current probe
  std::vector<Item> gathered_;
};

}  // namespace tess::collide::serial
