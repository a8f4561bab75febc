// How long a PE has been idle, for the monitor. Without one it costs a test of a flag whenever the
// PE becomes idle or busy, and none per message.
#pragma once

#include "runtime/machine/machine.hpp"

namespace tess::detail {

class IdleTime {
 public:
  /// From now on the time is measured.
  void start() { measured_ = true; }
  [[nodiscard]] bool measured() const { return measured_; }
  [[nodiscard]] bool idle() const { return idle_; }
  /// The PE has nothing to do.
  void begin(Time now) {
    if (idle_) return;
    idle_ = true;
    since_ = now;
  }
  /// The PE runs messages again.
  void end(Time now) {
    idle_ = false;
    total_ += now - since_;
  }
  /// The sum of all idle times that have ended.
  [[nodiscard]] Time total() const { return total_; }

 private:
  bool measured_ = false;
  bool idle_ = false;
  Time since_{0}, total_{0};
};

}  // namespace tess::detail
