// The processor time of the whole process, which stays on one core: a library that starts threads
// gains nothing from them, and other programs on the machine are not counted.
#pragma once

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

/// Binds this thread, and those that it starts from now on, to the core that it runs on. False if
/// the system refuses.
inline bool stay_on_one_core() {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<unsigned>(sched_getcpu()), &one);
  return sched_setaffinity(0, sizeof one, &one) == 0;
}

}  // namespace bench
