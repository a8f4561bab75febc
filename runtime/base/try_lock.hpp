// A lock that is taken or not, never waited for: whoever fails leaves its work to the holder, or to
// a later try. It guards what one thread at a time may do and no thread has to: progress of MPI.
#pragma once

#include <atomic>

namespace tess {

/// For std::unique_lock with std::try_to_lock, too. Any thread.
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

}  // namespace tess
