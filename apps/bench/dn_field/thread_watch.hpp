// The CPU time of the calling thread since the watch was made.
#pragma once

#include "runtime/core/cpu_clock.hpp"

namespace bench {

class ThreadWatch {
 public:
  [[nodiscard]] double nanoseconds() const {
    return static_cast<double>(tess::thread_cpu_nanoseconds() - begin_);
  }

 private:
  std::int64_t begin_ = tess::thread_cpu_nanoseconds();
};

}  // namespace bench
