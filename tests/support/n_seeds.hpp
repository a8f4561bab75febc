// How many seeds of the simulated machine a test tries.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace tess::test {

/// TESS_SEEDS of them, if that is set and less. Otherwise all in release; with the address
/// sanitizer, which takes ten times as long, a quarter; with the thread sanitizer two, because that
/// machine is one thread.
[[nodiscard]] inline std::uint64_t n_seeds(std::uint64_t in_release) {
  if (const char* const given = std::getenv("TESS_SEEDS"))
    return std::min<std::uint64_t>(in_release, std::strtoull(given, nullptr, 10));
#if defined(__SANITIZE_THREAD__)
  return std::min<std::uint64_t>(in_release, 2);
#elif defined(__SANITIZE_ADDRESS__)
  return std::min<std::uint64_t>(in_release, 2 + in_release / 4);
#else
  return in_release;
#endif
}

}  // namespace tess::test
