// Processor time of the calling thread since it was made, so that other programs on the machine
// count less than by the clock.
#pragma once

#include <ctime>

namespace bench {

class ThreadWatch {
 public:
  ThreadWatch() : begin_(now()) {}
  [[nodiscard]] double nanoseconds() const { return now() - begin_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
  }
  double begin_;
};

}  // namespace bench
