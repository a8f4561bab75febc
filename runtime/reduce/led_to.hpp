// Which reductions the broadcasts of a collection have led to, as far as one PE knows. It
// determines where an element joins that was created between two broadcasts (see ReductionTree).
// The list has a few entries, ascending in both numbers; entries of complete reductions are
// removed.
#pragma once

#include "runtime/core/algorithm.hpp"

#include <cstdint>
#include <vector>

namespace tess::detail {

class LedTo {
 public:
  /// One past the last reduction that broadcasts up to this one led to; 0 if none is known.
  [[nodiscard]] std::uint32_t end(std::uint32_t broadcast) const {
    std::uint32_t found = 0;
    for (const ReductionEnd& entry : entries_) {
      if (entry.broadcast > broadcast) break;
      found = entry.end;
    }
    return found;
  }

  /// Records that this broadcast led to a contribution to reduction `number`. Returns false if that
  /// was known.
  bool learn(std::uint32_t broadcast, std::uint32_t number) {
    if (end(broadcast) > number) return false;
    const auto at = std::lower_bound(
        entries_.begin(), entries_.end(), broadcast,
        [](const ReductionEnd& entry, std::uint32_t least) { return entry.broadcast < least; });
    const auto last = std::find_if(
        at, entries_.end(), [&](const ReductionEnd& entry) { return entry.end > number + 1; });
    entries_.insert(entries_.erase(at, last), ReductionEnd{broadcast, number + 1});
    return true;
  }

  /// Reductions below this one are complete: no element will join there.
  void forget_below(std::uint32_t number) {
    const auto last = std::find_if(entries_.begin(), entries_.end(),
                                   [&](const ReductionEnd& entry) { return entry.end > number; });
    entries_.erase(entries_.begin(), last);
  }

 private:
  struct ReductionEnd {
    std::uint32_t broadcast = 0;
    std::uint32_t end = 0;
  };
  std::vector<ReductionEnd> entries_;
};

}  // namespace tess::detail
