// What observes a PE: each part is null unless the run asks for it.
//
//     meter      what elements cost         a balancer, --stats, a trace, a watch
//     trace      what ran and when          --trace
//     watch      what runs now              --hang-report
//     idle time                             --monitor
//     audit      messages between PEs       --audit
//
// Only the thread that runs the PE uses it, but the watch, which another thread reads.
#pragma once

#include "runtime/pe/measure/trace.hpp"
#include "runtime/pe/meter.hpp"

#include <cstddef>
#include <memory>
#include <vector>

namespace tess::detail {

class IdleTime;
class MessageAudit;
class Pe;
class PeWatch;
struct AuditRow;
struct LoadRecord;
struct MessageFault;

class Measuring {
 public:
  explicit Measuring(Pe& pe);
  Measuring(const Measuring&) = delete;
  Measuring& operator=(const Measuring&) = delete;
  ~Measuring();

  /// Measures this PE's code; null if nothing requests it.
  [[nodiscard]] Meter* meter() const { return meter_.get(); }
  /// Starts measuring.
  Meter& start_meter();
  /// Measures until stop_brief_meter(), or for good if start_meter() is called meanwhile.
  Meter& start_brief_meter();
  void stop_brief_meter();
  /// The record ends or leaves this PE: its meters write to it no more.
  void forget(const LoadRecord& record);

  [[nodiscard]] Trace* trace() const { return trace_.get(); }
  void start_trace(std::size_t most_records);

  /// What this PE runs, for a watching thread. With it the PE has a meter.
  [[nodiscard]] PeWatch* watch() const { return watch_.get(); }
  void start_watch();

  /// How long this PE has been idle.
  [[nodiscard]] IdleTime* idle_time() const { return idle_time_.get(); }
  void start_idle_time();

  /// Counts the messages to and from other PEs. A trace cannot be kept beside.
  [[nodiscard]] MessageAudit* audit() const { return audit_.get(); }
  void start_audit(const MessageFault& fault);
  /// What was counted; empty without an audit.
  [[nodiscard]] std::vector<AuditRow> audit_rows() const;

 private:
  Pe& pe_;
  std::unique_ptr<Meter> meter_;
  std::unique_ptr<Meter> idle_meter_;  // one that measured briefly; scopes may still refer to it
  bool measures_briefly_ = false;
  std::unique_ptr<Trace> trace_;
  std::unique_ptr<PeWatch> watch_;
  std::unique_ptr<IdleTime> idle_time_;
  std::unique_ptr<MessageAudit> audit_;
};

}  // namespace tess::detail
