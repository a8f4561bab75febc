// Several messages to one PE, handed over at once. The receiver gets an array of pointers, so it
// can prefetch the next messages while it runs the first. A bundle costs its sender one atomic
// operation, independent of the number of messages.
#pragma once

#include "runtime/base/link.hpp"

#include <array>
#include <cstdint>

namespace tess::detail {

/// Occupies four cache lines, including the header of its pool block.
struct Bundle : Link {
  static constexpr std::uint32_t capacity = 28;
  std::uint32_t n = 0;
  bool prioritised = false;              ///< one of them has a priority
  std::array<Link*, capacity> messages;  // the first n
};

}  // namespace tess::detail
