// Lets one thread sleep until another has work for it. The sleeper announces that it is about to
// sleep and then checks its queues once more; a producer pushes and then checks for the
// announcement. All four operations are seq_cst, so at least one thread sees the other, and no
// wake-up is lost:
//
//     sleeper: state = asleep;  check queue;  sleep       producer: push;  check state;  wake
//
// While the sleeper is awake, wake() is one load.
#pragma once

#include "runtime/core/duration.hpp"

#include <atomic>
#include <cstdint>

namespace tess::detail {

/// One thread parks; any thread wakes it.
class Parker {
 public:
  Parker() = default;
  Parker(const Parker&) = delete;
  Parker& operator=(const Parker&) = delete;
  ~Parker() = default;

  /// Sleeps until wake() or until the time limit; does not sleep if `ready()` holds after the
  /// announcement. It may also return without a reason. `forever` means no limit.
  template <class Ready>
  void park(std::chrono::nanoseconds limit, Ready ready) {
    state_.store(asleep, std::memory_order_seq_cst);
    if (!ready()) sleep(limit);
    state_.store(awake, std::memory_order_relaxed);  // a late wake() is harmless
  }

  /// Ends the other thread's park(), if it is parked. Make the work visible first (seq_cst).
  void wake() noexcept {
    if (state_.load(std::memory_order_seq_cst) == awake) return;
    if (state_.exchange(awake, std::memory_order_seq_cst) == asleep) rouse();
  }

  static constexpr std::chrono::nanoseconds forever{-1};

 private:
  static constexpr std::uint32_t awake = 0;
  static constexpr std::uint32_t asleep = 1;

  void sleep(std::chrono::nanoseconds limit) noexcept;
  void rouse() noexcept;

  std::atomic<std::uint32_t> state_{awake};
};

}  // namespace tess::detail
