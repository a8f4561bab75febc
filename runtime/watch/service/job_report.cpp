#include "runtime/watch/service/job_report.hpp"

#include "runtime/core/text.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>

namespace tess::detail {

JobReport::JobReport(std::uint64_t round, std::int32_t n_processes)
    : round_(round), reported_(static_cast<std::size_t>(n_processes)), n_missing_(n_processes) {}

void JobReport::take(ProcessReport&& report) {
  const auto process = static_cast<std::size_t>(report.process.value);
  if (reported_.at(process)) return;
  reported_[process] = true;
  --n_missing_;
  active_ = active_ || report.active;
  waits_.merge(std::move(report.waits));
  audit_.insert(audit_.end(), report.audit.begin(), report.audit.end());
  silent_.insert(silent_.end(), report.silent.begin(), report.silent.end());
}

std::string JobReport::finish(const Runtime& runtime) {
  if (reported_.size() > 1) {
    for (std::size_t i = 0; i < reported_.size(); ++i)
      if (!reported_[i])
        waits_.add(WaitRank::handler,
                   text(ProcessId{static_cast<std::int32_t>(i)},
                        " has not answered: all its PEs are in entry methods, or it has ended"));
  }
  const auto answered = [&](PeId pe) {
    const std::size_t process =
        reported_.size() > 1 ? static_cast<std::size_t>(runtime.machine().process_of(pe).value) : 0;
    return reported_[process] && std::find(silent_.begin(), silent_.end(), pe) == silent_.end();
  };
  const std::string audit = runtime.audit_text(audit_, answered);
  return (waits_.empty() ? "nothing waits" : list_of_waiting(std::move(waits_))) + audit;
}

}  // namespace tess::detail
