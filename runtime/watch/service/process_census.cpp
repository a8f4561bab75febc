#include "runtime/watch/service/process_census.hpp"

#include "runtime/pe/runtime.hpp"

#include <utility>

namespace tess::detail {

ProcessCensus::ProcessCensus(int signal, std::uint64_t round, std::uint64_t job_round,
                             PeId first_pe, std::int32_t n_pes)
    : signal_(signal),
      round_(round),
      job_round_(job_round),
      first_pe_(first_pe),
      answers_(static_cast<std::size_t>(n_pes)),
      n_missing_(answers_.size()) {}

bool ProcessCensus::take(PeId pe, Waits&& waits, const std::vector<AuditRow>& counted) {
  auto& answer = answers_.at(static_cast<std::size_t>(pe.value - first_pe_.value));
  if (answer) return false;
  answer = std::move(waits);
  counted_.insert(counted_.end(), counted.begin(), counted.end());
  return --n_missing_ == 0;
}

ProcessReport ProcessCensus::finish(Runtime& runtime, std::chrono::milliseconds limit) {
  reported_ = true;
  ProcessReport of;
  of.process = runtime.machine().process();
  of.job_round = job_round_;
  for (std::size_t i = 0; i < answers_.size(); ++i) {
    if (auto& answer = answers_[i]; answer) {
      of.waits.merge(std::move(*answer));
      continue;
    }
    const PeId pe{first_pe_.value + static_cast<std::int32_t>(i)};
    of.silent.push_back(pe);
    of.waits.add(WaitRank::handler, text(pe, " has not answered within ", limit.count(),
                                         " ms: ", runtime.running_text(pe)));
  }
  of.audit = std::move(counted_);
  return of;
}

}  // namespace tess::detail
