// The report of a whole job: process 0 collects what each process reports. It is done once all have
// reported, or after a time limit. It also names what does not answer.
//
//     each process: its PEs' censuses, and what the PEs run that do not answer -> ProcessReport
//                   -> PE 0 -> JobReport of process 0
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/watch/report/audit.hpp"
#include "runtime/watch/report/waiting.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::detail {

class Runtime;

/// What the PEs of one process report.
struct ProcessReport {
  ProcessId process{};
  std::uint64_t job_round = 0;  ///< the round of process 0 that asked for it; 0: a signal did
  /// An entry method has begun lately, so the job does not hang; nothing else is filled in then.
  bool active = false;
  Waits waits;
  std::vector<AuditRow> audit;
  std::vector<PeId> silent;  ///< PEs that did not answer
};

/// What process 0 collects in one round.
class JobReport {
 public:
  JobReport(std::uint64_t round, std::int32_t n_processes);

  [[nodiscard]] std::uint64_t round() const { return round_; }
  /// Takes the report of a process; a second one of the same process has no effect.
  void take(ProcessReport&& report);
  [[nodiscard]] bool complete() const { return n_missing_ == 0; }
  /// A process has reported that it is not idle.
  [[nodiscard]] bool active() const { return active_; }
  /// The text, once; processes that are missing are named.
  [[nodiscard]] std::string finish(const Runtime& runtime);

 private:
  const std::uint64_t round_;
  std::vector<bool> reported_;  // by process
  std::int32_t n_missing_;
  bool active_ = false;
  Waits waits_;
  std::vector<AuditRow> audit_;
  std::vector<PeId> silent_;
};

}  // namespace tess::detail
