// How long a PE has been idle, for the monitor: without one the PE has none.
#pragma once

#include "runtime/wire/machine/machine.hpp"

namespace tess::detail {

class IdleTime {
 public:
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
  bool idle_ = false;
  Time since_{0}, total_{0};
};

}  // namespace tess::detail
