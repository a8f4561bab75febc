// Counts of local elements by the number of their next reduction. Nearly all elements are at one or
// two consecutive numbers, so a window of counters suffices; no number below its first has any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tess::detail {

/// Counts by number, with fast access to the lowest.
class NumberCounts {
 public:
  [[nodiscard]] bool empty() const { return head_ == counts_.size(); }
  /// The lowest number with a count above 0; there must be one.
  [[nodiscard]] std::uint32_t lowest() const { return first_; }

  void add(std::uint32_t number) {
    if (empty()) {
      clear();
      first_ = number;
    }
    if (number < first_) [[unlikely]]
      extend_down(number);
    if (head_ + (number - first_) >= counts_.size()) [[unlikely]]
      extend_up(number);
    ++counts_[head_ + (number - first_)];
  }

  /// Removes a number that was added.
  void remove(std::uint32_t number) {
    --counts_[head_ + (number - first_)];
    while (!empty() && counts_[head_] == 0) {
      ++head_;
      ++first_;
    }
  }

 private:
  void clear() {
    counts_.clear();
    head_ = 0;
  }
  void extend_up(std::uint32_t number);
  void extend_down(std::uint32_t number);

  // counts_[head_ + k] is the count of number first_ + k; counters below head_ are zero.
  std::vector<std::uint64_t> counts_;
  std::size_t head_ = 0;
  std::uint32_t first_ = 0;
};

}  // namespace tess::detail
