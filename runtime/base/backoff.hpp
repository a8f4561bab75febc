// What a thread that finds nothing to do does next: spin, then yield, then sleep. Each stage lasts
// a given time since the last work; where threads outnumber cores the spinning stage is left out,
// since a spinning thread keeps from its core the one it waits for.
#pragma once

#include <chrono>
#include <sched.h>

namespace tess {

/// How long each stage lasts and how long a sleep is.
struct Patience {
  std::chrono::nanoseconds spin{0};
  std::chrono::nanoseconds yield{0};
  std::chrono::nanoseconds sleep{-1};  // limit of one sleep; negative: until woken
};

/// Lets the other hyperthread run for some ten cycles.
inline void pause_cpu() noexcept {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// One thread's; call pause() each time nothing was found, reset() each time something was.
class Backoff {
 public:
  explicit Backoff(Patience patience) noexcept : patience_(patience) {}

  void reset() noexcept { n_pauses_ = 0; }

  /// Spins or yields once; true, without any pause, when it is time to sleep.
  [[nodiscard]] bool pause() noexcept {
    if (n_pauses_ == 0) {
      stage_ = patience_.spin.count() > 0 ? Stage::spin : Stage::yield;
      idle_since_ = Clock::now();
    } else if (n_pauses_ % 16 == 0 || stage_ != Stage::spin) {
      const auto idle = Clock::now() - idle_since_;
      if (idle > patience_.spin) stage_ = Stage::yield;
      if (idle > patience_.spin + patience_.yield) stage_ = Stage::sleep;
    }
    ++n_pauses_;
    switch (stage_) {
      case Stage::spin:
        pause_cpu();
        return false;
      case Stage::yield:
        sched_yield();
        return false;
      case Stage::sleep:
        break;
    }
    return true;
  }

  [[nodiscard]] std::chrono::nanoseconds sleep() const noexcept { return patience_.sleep; }

 private:
  using Clock = std::chrono::steady_clock;
  enum class Stage { spin, yield, sleep };

  Patience patience_;
  Stage stage_ = Stage::spin;
  unsigned n_pauses_ = 0;
  Clock::time_point idle_since_;
};

}  // namespace tess
