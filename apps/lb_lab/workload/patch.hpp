// The cells of one element with a halo of one: the numerics of a workload, without messages.
#pragma once

#include "apps/lb_lab/workload/workload.hpp"

#include <cstdint>
#include <vector>

namespace lb_lab {

class Patch {
 public:
  Patch() = default;
  Patch(const Problem& problem, const Block& block);

  /// The outermost states on a side, in the order of growing coordinate.
  [[nodiscard]] std::vector<std::uint64_t> edge(Side side) const;
  /// The neighbour's states beyond a side; 0 where there is none.
  void set_halo(Side side, const std::vector<std::uint64_t>& states);

  /// One iteration of all cells.
  void advance(const Problem& problem, std::int32_t iteration);

  /// The word that the walk of this iteration starts from, and the word that it ends with: the
  /// state changes if they differ.
  [[nodiscard]] std::uint64_t word() const { return now_[at(0, 0)]; }
  void take(std::uint64_t walked) { now_[at(0, 0)] = walked; }

  /// This block's part of the answer.
  [[nodiscard]] std::uint64_t answer(const Problem& problem) const;

  [[nodiscard]] const Block& block() const { return block_; }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(block_, now_, cargo_);
  }

 private:
  struct Line {
    std::size_t first, stride, n;
  };
  [[nodiscard]] Line line(Side side, std::int32_t out) const;
  [[nodiscard]] std::size_t at(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(block_.width + 2) +
           static_cast<std::size_t>(x + 1);
  }

  Block block_;
  std::vector<std::uint64_t> now_, next_;  // (height + 2) × (width + 2), row-major
  std::vector<std::uint64_t> cargo_;       // cell after cell
};

}  // namespace lb_lab
