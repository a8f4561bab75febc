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
  void insert(std::uint64_t number);

  [[nodiscard]] bool contains(std::uint64_t number) const {
    const auto after = ends_.upper_bound(number);
    return after != ends_.begin() && number < std::prev(after)->second;
  }

  [[nodiscard]] std::size_t n_intervals() const { return ends_.size(); }

 private:
  std::map<std::uint64_t, std::uint64_t> ends_;  // the first member -> one past the last
};

}  // namespace tess::detail
