#include "runtime/reduce/number_counts.hpp"

namespace tess::detail {
namespace {

constexpr std::size_t most_below = 32;

}  // namespace

void NumberCounts::extend_up(std::uint32_t number) {
  if (head_ >= most_below) {
    counts_.erase(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(head_));
    head_ = 0;
  }
  counts_.resize(head_ + (number - first_) + 1);
}

void NumberCounts::extend_down(std::uint32_t number) {
  const std::size_t more = first_ - number;
  if (head_ >= more) {
    head_ -= more;  // the counters below the head are zero
  } else {
    counts_.insert(counts_.begin(), more - head_, 0);
    head_ = 0;
  }
  first_ = number;
}

}  // namespace tess::detail
