#include "runtime/base/interval_set.hpp"

namespace tess::detail {

void IntervalSet::insert(std::uint64_t number) {
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

}  // namespace tess::detail
