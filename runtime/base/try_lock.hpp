// A lock on which no PE waits for its messages: a thread that fails to take it leaves its work to
// the holder or to a later attempt. It guards work that one thread at a time may do and no thread
// must do, such as progress of MPI.
#pragma once

#include <atomic>

namespace tess::detail {

/// May be used through std::unique_lock with std::try_to_lock. Any thread.
class TryLock {
 public:
  [[nodiscard]] bool try_lock() noexcept {
    return !taken_.load(std::memory_order_relaxed) &&
           !taken_.exchange(true, std::memory_order_acquire);  // partner: unlock()
  }
  void unlock() noexcept { taken_.store(false, std::memory_order_release); }

 private:
  std::atomic<bool> taken_{false};
};

}  // namespace tess::detail
