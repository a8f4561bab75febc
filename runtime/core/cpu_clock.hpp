// CPU time of the calling thread: what other threads and programs do on the same core is not
// counted.
#pragma once

#include <cstdint>
#include <ctime>

namespace tess {

[[nodiscard]] inline std::int64_t thread_cpu_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

[[nodiscard]] inline double thread_cpu_seconds() {
  return 1e-9 * static_cast<double>(thread_cpu_nanoseconds());
}

}  // namespace tess
