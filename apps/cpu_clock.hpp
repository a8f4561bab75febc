// CPU time of the calling thread: it does not count what other threads do on the same core.
#pragma once

#include <ctime>

namespace apps {

[[nodiscard]] inline double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace apps
