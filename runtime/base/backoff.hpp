// How a thread without work waits: it spins, then yields, then sleeps. Each stage lasts a given
// time since the last work. The spinning stage is left out if there are more threads than cores,
// since a spinning thread would occupy the core that the thread it waits for needs.
//
// If another program runs on the same core, a thread that spins or yields loses the core for
// milliseconds each time, whereas a sleeping thread gets it back as soon as it is woken. A gap in
// the waiting thread's time reveals such a program; for a while the thread then sleeps at once.
#pragma once

#include "runtime/core/duration.hpp"

#include <algorithm>
#include <sched.h>

namespace tess::detail {

/// The duration of each stage and of one sleep.
struct Patience {
  std::chrono::nanoseconds spin{0};
  std::chrono::nanoseconds yield{0};
  std::chrono::nanoseconds sleep{-1};         // limit of one sleep; negative: until woken
  std::chrono::nanoseconds longest_sleep{0};  // the limit grows to this with the time since work
};

/// Lets the other hyperthread run for some ten cycles.
inline void pause_cpu() noexcept {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// The waiting state of one thread: call pause() when no work was found and reset() when some was.
class Backoff {
 public:
  explicit Backoff(Patience patience) noexcept : patience_(patience) {}

  /// Work was found.
  void reset() noexcept {
    if (n_pauses_ >= 16 || (n_pauses_ > 0 && stage_ == Stage::yield)) look(Clock::now());
    n_pauses_ = 0;
  }

  /// Spins or yields once; true, without any pause, when it is time to sleep.
  [[nodiscard]] bool pause() noexcept {
    if (n_pauses_ == 0) {
      idle_since_ = last_look_ = Clock::now();
      stage_ = idle_since_ < crowded_until_ ? Stage::sleep
               : patience_.spin.count() > 0 ? Stage::spin
                                            : Stage::yield;
    } else if (n_pauses_ % 16 == 0 || stage_ != Stage::spin) {
      const auto now = Clock::now();
      const auto idle = now - idle_since_;
      if (idle > patience_.spin) stage_ = Stage::yield;
      if (look(now) || idle > patience_.spin + patience_.yield) stage_ = Stage::sleep;
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

  /// The limit of the next sleep: a sixteenth of the time since the last work, so that what arrives
  /// during a sleep waits for a small part of the time that it was awaited.
  [[nodiscard]] std::chrono::nanoseconds sleep() const noexcept {
    const std::chrono::nanoseconds grown = (last_look_ - idle_since_) / 16;
    return std::max(patience_.sleep, std::min(grown, patience_.longest_sleep));
  }

 private:
  using Clock = std::chrono::steady_clock;
  enum class Stage { spin, yield, sleep };
  /// A gap of this length means that the core is shared: other PEs of ours yield sooner, and a time
  /// slice of the system scheduler is longer.
  static constexpr std::chrono::microseconds gap{400};
  static constexpr std::chrono::milliseconds first_crowded{5}, longest_crowded{320};

  /// True if the time since the last call shows that the core is shared with another program.
  bool look(Clock::time_point now) noexcept {
    if (stage_ != Stage::sleep && now - last_look_ > gap) {
      // The period grows if the last one ended recently.
      const bool again = now - crowded_until_ < 4 * crowded_for_;
      crowded_for_ = again ? std::min(2 * crowded_for_, longest_crowded) : first_crowded;
      crowded_until_ = now + crowded_for_;
    }
    last_look_ = now;
    return now < crowded_until_;
  }

  Patience patience_;
  Stage stage_ = Stage::spin;
  unsigned n_pauses_ = 0;
  Clock::time_point idle_since_, last_look_;
  Clock::time_point crowded_until_{};
  std::chrono::milliseconds crowded_for_ = first_crowded;
};

}  // namespace tess::detail
