// Union-find over the numbers 0 to n − 1. A set is named by its lowest number, so that names do not
// depend on the order of joining.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace tess::dn {

class DisjointSets {
 public:
  /// Each number is a set of its own.
  explicit DisjointSets(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// The lowest number of the set that holds `v`.
  [[nodiscard]] std::uint32_t set_of(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax({set_of(a), set_of(b)});
    parent_[high] = low;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace tess::dn
