// A set of numbers that come nearly in a row, kept as disjoint intervals: its size is that of the
// gaps, not of the members. What a PE remembers of collections that have ended.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>

namespace tess {

class IntervalSet {
 public:
  /// Inserting a member again does nothing. Any number but the greatest.
  void insert(std::uint64_t number) {
    const auto after = ends_.upper_bound(number);  // the first interval that begins beyond
    const auto before = after == ends_.begin() ? ends_.end() : std::prev(after);
    if (before != ends_.end() && number < before->second) return;
    const bool joins_after = after != ends_.end() && after->first == number + 1;
    const std::uint64_t end = joins_after ? after->second : number + 1;
    if (joins_after) ends_.erase(after);
    if (before != ends_.end() && before->second == number) {
      before->second = end;
    } else {
      ends_.emplace(number, end);
    }
  }

  [[nodiscard]] bool contains(std::uint64_t number) const {
    const auto after = ends_.upper_bound(number);
    return after != ends_.begin() && number < std::prev(after)->second;
  }

  [[nodiscard]] std::size_t n_intervals() const { return ends_.size(); }

 private:
  std::map<std::uint64_t, std::uint64_t> ends_;  // the first member -> one past the last
};

}  // namespace tess
