// The monitor of a run (--monitor [ADDRESS:]PORT): process 0 asks all PEs for samples twice a
// second, and serves a page that draws them. Other processes have no thread for it.
//
//     thread of process 0, every period:  asks each PE that has answered the last time: those of its
//                                         process itself, the others by way of PE 0
//     PE:                                 sample_of(pe) -> board of process 0
//     thread of process 0, every period:  board -> frame -> all browsers (server.hpp)
//
// None of these messages is counted by an epoch, so the run ends as it would without them. A PE
// that runs a long entry method answers when it is over; until then the page shows it as busy, with
// the name of the entry method if it is one of process 0. On the simulated machine the samples are
// taken every period of wall time and show virtual time; their messages take part in the schedule.
#pragma once

#include "runtime/pe/interfaces/process_monitor.hpp"
#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/watch/monitor/sample.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tess::detail {

class Runtime;

class Monitor final : public ProcessMonitor {
 public:
  /// On process 0 it serves from now on. Throws Error if the port cannot be had.
  Monitor(Runtime& runtime, const MonitorOptions& options);
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  ~Monitor() override;

  void balanced(Pe& pe, BalanceNote note) override;
  void close() override;

  [[nodiscard]] bool wants_part(const Pe& pe, std::string_view name, std::uint64_t part) override;
  void draw(Pe& pe, PicturePart part) override;

  /// The thread and its state. Handlers of its messages on the PEs call it.
  class Loop;
  [[nodiscard]] Loop& loop() { return *loop_; }

 private:
  std::unique_ptr<Loop> loop_;
};

}  // namespace tess::detail
