// A set of local ids that is filled and cleared many times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tess::m2m {

/// Collects ids without repeats, in the order in which they come.
class Gather {
 public:
  explicit Gather(std::size_t n_ids) : seen_(n_ids, 0) {}
  /// Starts a new collection.
  void clear() {
    for (const std::int32_t id : found) seen_[static_cast<std::size_t>(id)] = 0;
    found.clear();
  }
  void add(std::int32_t id) {
    std::uint8_t& seen = seen_[static_cast<std::size_t>(id)];
    if (seen == 0) found.push_back(id);
    seen = 1;
  }
  std::vector<std::int32_t> found;

 private:
  std::vector<std::uint8_t> seen_;
};

}  // namespace tess::m2m
