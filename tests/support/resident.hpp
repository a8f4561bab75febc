// Memory that does not grow: the resident memory of this process in a loop, from a quarter of its
// rounds to its end. A test that uses it has a process of its own, since memory that earlier tests
// have freed would hide what a loop leaves behind.
#pragma once

#include "runtime/base/usable_memory.hpp"

#include <cstdint>

namespace tess::test {

class Growth {
 public:
  explicit Growth(int n_rounds) : n_rounds_(n_rounds) {}

  [[nodiscard]] int n_rounds() const { return n_rounds_; }
  /// After each round, counted from 1.
  void after(int round) {
    if (round == n_rounds_ / 4) at_quarter_ = static_cast<std::int64_t>(detail::resident_memory());
    if (round == n_rounds_) at_end_ = static_cast<std::int64_t>(detail::resident_memory());
  }
  /// Bytes; −1 if the loop did not come to its end.
  [[nodiscard]] std::int64_t bytes() const {
    return at_end_ == 0 ? -1 : at_end_ < at_quarter_ ? 0 : at_end_ - at_quarter_;
  }

 private:
  const int n_rounds_;
  std::int64_t at_quarter_ = 0, at_end_ = 0;
};

}  // namespace tess::test
