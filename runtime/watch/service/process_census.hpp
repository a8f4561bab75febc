// The census of one process: each of its PEs answers once with what waits on it. It is done once
// all have answered, or after a time limit; then it also names the PEs that have not. The service
// guards it with its mutex.
#pragma once

#include "runtime/watch/report/audit.hpp"
#include "runtime/watch/report/waiting.hpp"
#include "runtime/watch/service/job_report.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace tess::detail {

class ProcessCensus {
 public:
  /// `job_round`: the round of process 0 that asks for it; 0: none does.
  ProcessCensus(int signal, std::uint64_t round, std::uint64_t job_round, PeId first_pe,
                std::int32_t n_pes);

  [[nodiscard]] int signal() const { return signal_; }
  [[nodiscard]] std::uint64_t round() const { return round_; }
  /// Process 0 asks, too: the report is for its round.
  void serve_job(std::uint64_t round) { job_round_ = round; }

  /// A PE answers; a second answer has no effect. Returns true at the last of the answers.
  [[nodiscard]] bool take(PeId pe, Waits&& waits, const std::vector<AuditRow>& counted);
  [[nodiscard]] bool reported() const { return reported_; }
  /// The report, once: what the PEs have answered, and what those run that
  /// have not within `limit`.
  [[nodiscard]] ProcessReport finish(Runtime& runtime, std::chrono::milliseconds limit);

 private:
  const int signal_;
  const std::uint64_t round_;
  std::uint64_t job_round_;
  const PeId first_pe_;
  std::vector<std::optional<Waits>> answers_;  // by PE of this process
  std::vector<AuditRow> counted_;
  std::size_t n_missing_;
  bool reported_ = false;
};

}  // namespace tess::detail
