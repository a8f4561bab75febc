// libexodusII is not reentrant: readers and writers take turns in a process.
#pragma once

#include <mutex>

namespace tess::m2m {

/// Lives while its thread may call the library. A thread may have several.
class ExodusTurn {
 public:
  ExodusTurn() : turn_(library()) {}

 private:
  static std::recursive_mutex& library() {
    static std::recursive_mutex mutex;
    return mutex;
  }
  std::lock_guard<std::recursive_mutex> turn_;
};

}  // namespace tess::m2m
