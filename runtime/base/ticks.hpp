// The cycle counter: the cheapest clock. It has a constant rate and is common to all cores of a
// machine; a reading costs a few nanoseconds and never enters the kernel.
#pragma once

#include "runtime/core/duration.hpp"

#include <cstdint>

namespace tess::detail {

[[nodiscard]] inline std::uint64_t read_ticks() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

/// Seconds per tick; measured once per process, over a millisecond.
[[nodiscard]] inline double seconds_per_tick() {
  static const double rate = [] {
    using Clock = std::chrono::steady_clock;
    const auto began = Clock::now();
    const std::uint64_t first = read_ticks();
    auto now = began;
    while (now - began < std::chrono::milliseconds(1)) now = Clock::now();
    return std::chrono::duration<double>(now - began).count() /
           static_cast<double>(read_ticks() - first);
  }();
  return rate;
}

}  // namespace tess::detail
