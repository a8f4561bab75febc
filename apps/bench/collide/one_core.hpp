// The processor time of the whole process, which stays on one core: a library that starts threads
// gains nothing from them, and other programs on the machine are not counted.
#pragma once

#include "runtime/core/check.hpp"

#include <ctime>
#include <sched.h>

namespace bench {

class ProcessWatch {
 public:
  ProcessWatch() : begin_(now()) {}
  [[nodiscard]] double nanoseconds() const { return now() - begin_; }

 private:
  static double now() {
    timespec at{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
    return 1e9 * static_cast<double>(at.tv_sec) + static_cast<double>(at.tv_nsec);
  }
  double begin_;
};

/// Binds this thread, and those that it starts, to the core that it runs on, as long as it lives.
class OneCore {
 public:
  OneCore() {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<unsigned>(sched_getcpu()), &one);
    TESS_CHECK(sched_getaffinity(0, sizeof before_, &before_) == 0 &&
                   sched_setaffinity(0, sizeof one, &one) == 0,
               "the system does not bind this process to a core");
  }
  OneCore(const OneCore&) = delete;
  OneCore& operator=(const OneCore&) = delete;
  ~OneCore() { sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_{};
};

}  // namespace bench
