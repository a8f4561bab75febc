// The interface by which the runtime reports to the monitor of its process (--monitor). The monitor
// layer implements it.
#pragma once

#include <string>

namespace tess::detail {

class Pe;

/// What a balance round did, for the monitor.
struct BalanceNote {
  std::string text;      ///< one line that describes it
  double before = 1;     ///< max/average that was measured before the round
  double predicted = 1;  ///< the strategy's prediction

  template <class Ar>
  void serialize(Ar& ar) {
    ar(text, before, predicted);
  }
};

class ProcessMonitor {
 public:
  ProcessMonitor() = default;
  ProcessMonitor(const ProcessMonitor&) = delete;
  ProcessMonitor& operator=(const ProcessMonitor&) = delete;
  virtual ~ProcessMonitor() = default;

  /// A balance round is over. Called on the PE that decided.
  virtual void balanced(Pe& pe, BalanceNote note) = 0;
  /// The PEs leave the run: nothing is posted to them any more. Any PE thread.
  virtual void close() = 0;
};

}  // namespace tess::detail
