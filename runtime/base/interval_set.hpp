// A set of numbers that are nearly consecutive, stored as disjoint intervals: its size grows with
// the number of gaps, not of members. A PE records ended collections in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>  // also std::prev: <iterator> would bring those of streams into every program

namespace tess::detail {

class IntervalSet {
 public:
  /// Inserts any number except the greatest. Inserting a member again has no effect.
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

}  // namespace tess::detail
