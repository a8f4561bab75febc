// Watches the PEs of a process that has --hang-report: since when no entry method has begun, and
// which entry methods take too long. The service calls it a few times per limit: from its thread,
// or on a simulated machine from PE 0, where the times are virtual.
#pragma once

#include "runtime/wire/machine/machine.hpp"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace tess::detail {

class Runtime;

class HangWatch {
 public:
  using Clock = std::chrono::steady_clock;

  HangWatch(Runtime& runtime, Time limit, Clock::time_point now);

  [[nodiscard]] Time limit() const { return limit_; }
  /// The time between two calls of look() in real time.
  [[nodiscard]] Time period() const;

  /// Returns a line for each entry method that has taken longer than the limit since the last call.
  [[nodiscard]] std::vector<std::string> look(Clock::time_point now);
  /// The time since an entry method has begun here, as far as look() saw.
  [[nodiscard]] Time idle(Clock::time_point now) const { return now - changed_; }
  /// True if a report is due: nothing has begun for the limit, and that has not been reported.
  [[nodiscard]] bool due(Clock::time_point now) const { return !reported_ && now >= next_; }
  /// It was reported: nothing is due before an entry method has begun.
  void reported() { reported_ = true; }
  /// Other processes are active: the question is asked again later.
  void ask_later(Clock::time_point now) { next_ = now + limit_ / 2; }

 private:
  Runtime& runtime_;
  const Time limit_;
  std::vector<std::uint64_t> n_entered_;  // by PE, as last seen
  std::vector<bool> named_;               // a long entry method of the PE has been reported
  Clock::time_point changed_, next_;
  bool reported_ = false;
};

}  // namespace tess::detail
