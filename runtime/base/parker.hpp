// How one thread sleeps until another has work for it. The sleeper announces that it is about to
// sleep and then looks at its queues once more; a producer pushes and then looks whether the
// sleeper announced. All four are seq_cst, so one of the two sees the other, and no wake-up is
// lost:
//
//     sleeper: state = asleep;  look at queue;  sleep       producer: push;  look at state;  wake
//
// While the sleeper is awake a wake() is one load.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace tess {

/// One thread parks; any thread wakes it.
class Parker {
 public:
  Parker() = default;
  Parker(const Parker&) = delete;
  Parker& operator=(const Parker&) = delete;
  ~Parker() = default;

  /// Sleeps until wake(), or until the time is over; not at all if `ready()` holds after the
  /// announcement. May also return for no reason. `forever` waits without limit.
  template <class Ready>
  void park(std::chrono::nanoseconds limit, Ready ready) {
    state_.store(asleep, std::memory_order_seq_cst);
    if (!ready()) sleep(limit);
    state_.store(awake, std::memory_order_relaxed);  // a wake() that comes too late does no harm
  }

  /// Ends the park() of the other thread, if it is in one. Make the work visible first (seq_cst).
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

}  // namespace tess
