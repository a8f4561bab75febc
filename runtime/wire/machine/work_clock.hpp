// How long the calling thread has worked, read many times per microsecond of work. A call of the
// operating system for the CPU time of the thread takes longer than a small message; so the clock
// counts the ticks of the cycle counter, and removes what is no work:
//
//   its own cost      measured when the clock is made, subtracted at each reading
//   stolen time       what other threads got on this core: after an interval that is long enough to
//                     hold a switch of threads, the ticks are compared with the CPU time
//   pauses            from pause() to resume()
//
// One thread uses a clock.
#pragma once

#include "runtime/base/ticks.hpp"
#include "runtime/core/cpu_clock.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace tess::detail {

/// The two clocks of the calling thread.
struct ThreadTime {
  [[nodiscard]] static std::uint64_t ticks() { return read_ticks(); }
  [[nodiscard]] static std::int64_t cpu_nanoseconds() { return thread_cpu_nanoseconds(); }
  [[nodiscard]] static double nanoseconds_per_tick() { return 1e9 * seconds_per_tick(); }
};

/// `Source` has the functions of ThreadTime.
template <class Source = ThreadTime>
class WorkClock {
 public:
  /// The clock is paused. Reads it some hundred times to measure its own cost.
  explicit WorkClock(Source source = {})
      : source_(std::move(source)),
        nanoseconds_per_tick_(source_.nanoseconds_per_tick()),
        long_ticks_(ticks(long_nanoseconds)),
        quantum_ticks_(ticks(quantum_nanoseconds)) {
    compare_from_here();
    own_ticks_ = measured_own_ticks();
  }

  void resume() {
    pass();
    works_ = true;
  }
  void pause() {
    pass();
    works_ = false;
  }
  /// The work so far, in nanoseconds; never less than at an earlier reading.
  [[nodiscard]] std::int64_t read() {
    if (works_) pass();
    return static_cast<std::int64_t>(static_cast<double>(work_) * nanoseconds_per_tick_);
  }
  /// The cost of a reading, which is subtracted.
  [[nodiscard]] double own_nanoseconds() const {
    return static_cast<double>(own_ticks_) * nanoseconds_per_tick_;
  }

 private:
  static constexpr double long_nanoseconds = 20e3;    // shorter intervals hold no switch of threads
  static constexpr double quantum_nanoseconds = 1e6;  // the ratio of the clocks is not exact
  static constexpr double noise_nanoseconds = 5e3;    // the two clocks differ without a reason
  static constexpr std::size_t n_tries = 301;

  [[nodiscard]] std::uint64_t ticks(double nanoseconds) const {
    return static_cast<std::uint64_t>(nanoseconds / nanoseconds_per_tick_);
  }

  /// Adds the interval since the last pass.
  void pass() {
    const std::uint64_t at = source_.ticks();
    std::uint64_t spent = at - last_;
    spent -= std::min(spent, own_ticks_);
    last_ = at;
    if (spent > long_ticks_ || at - compared_ticks_ > quantum_ticks_) [[unlikely]] {
      const double stolen = static_cast<double>(at - compared_ticks_) * nanoseconds_per_tick_ -
                            static_cast<double>(source_.cpu_nanoseconds() - compared_cpu_);
      if (spent > long_ticks_ && stolen > noise_nanoseconds)
        spent -= std::min(spent, ticks(stolen));
      compare_from_here();
    }
    if (works_) work_ += spent;
  }

  /// The next comparison of ticks and CPU time begins here.
  void compare_from_here() {
    compared_cpu_ = source_.cpu_nanoseconds();
    last_ = compared_ticks_ = source_.ticks();
  }

  /// The median of intervals with nothing in them.
  [[nodiscard]] std::uint64_t measured_own_ticks() {
    std::array<std::uint64_t, n_tries> tries{};
    works_ = true;
    for (std::uint64_t& one : tries) {
      const std::uint64_t before = work_;
      pass();
      one = work_ - before;
    }
    works_ = false;
    work_ = 0;
    std::nth_element(tries.begin(), tries.begin() + n_tries / 2, tries.end());
    return tries[n_tries / 2];
  }

  Source source_;
  double nanoseconds_per_tick_;
  std::uint64_t long_ticks_, quantum_ticks_;
  std::uint64_t own_ticks_ = 0;
  bool works_ = false;
  std::uint64_t work_ = 0;  // ticks
  std::uint64_t last_ = 0;  // the last pass
  std::uint64_t compared_ticks_ = 0;
  std::int64_t compared_cpu_ = 0;
};

}  // namespace tess::detail
