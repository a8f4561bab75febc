// What observes a PE: each part is null unless the run asks for it.
//
//     meter      what elements cost         a balancer, --stats, a trace, a watch
//     elements   their load in the run      --stats, a LoadMeasurement
//     trace      what ran and when          --trace
//     watch      what runs now              --hang-report
//     idle time                             --monitor
//     audit      messages between PEs       --audit
//
// Only the thread that runs the PE uses it, but the watch, which another thread reads.
#pragma once

#include "runtime/core/load_summary.hpp"
#include "runtime/pe/measure/load_record.hpp"
#include "runtime/pe/measure/trace.hpp"
#include "runtime/pe/meter.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace tess::detail {

class IdleTime;
class MessageAudit;
class Pe;
class PeWatch;
struct AuditRow;
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
  /// Measures until all that called it have called stop_brief_meter(), or for good if start_meter()
  /// is called.
  Meter& start_brief_meter();
  void stop_brief_meter();
  /// The record ends or leaves this PE: its meters write to it no more.
  void forget(const LoadRecord& record);

  /// From now on elements have records, also those that no balancer watches. Called again, it begins
  /// anew.
  void start_elements();
  /// Elements are measured no more, and the PE only if something else requests it.
  void stop_elements();
  [[nodiscard]] bool measures_elements() const { return measures_elements_; }
  /// An element ends after so many ticks.
  template <class Name>
  void ended(std::uint64_t ticks, const Name& name) {
    if (ticks > largest_ended_.ticks) largest_ended_ = {ticks, name()};
  }
  /// Since start_elements(). Without it: since the start, and only what --monitor measures. Called
  /// in a step.
  [[nodiscard]] PeLoad load() const;
  /// It counts what code of the main program takes on this PE.
  [[nodiscard]] LoadRecord& main_record() { return main_record_; }

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
  Meter& make_meter();

  struct Largest {
    std::uint64_t ticks = 0;
    std::string element;
  };

  Pe& pe_;
  std::unique_ptr<Meter> meter_;
  std::unique_ptr<Meter> idle_meter_;  // one that measured briefly; scopes may still refer to it
  int n_brief_ = 0;                    // that measure briefly
  bool measures_for_good_ = false;
  std::unique_ptr<Trace> trace_;
  std::unique_ptr<PeWatch> watch_;
  std::unique_ptr<IdleTime> idle_time_;
  std::unique_ptr<MessageAudit> audit_;
  bool measures_elements_ = false;
  LoadRecord main_record_;
  Largest largest_ended_;
  // When start_elements() was called: the meter's readings, and the messages.
  std::uint64_t began_ = 0, busy_before_ = 0, in_records_before_ = 0, messages_before_ = 0;
};

/// Marks that code of the main program runs, for the meter, the watch and the trace.
class MainScope {
 public:
  explicit MainScope(Pe& pe);
  MainScope(const MainScope&) = delete;
  MainScope& operator=(const MainScope&) = delete;
  ~MainScope() {
    if (meter_ != nullptr) meter_->leave(outer_);
  }

 private:
  Meter* const meter_;
  Meter::Scope outer_;
};

}  // namespace tess::detail
