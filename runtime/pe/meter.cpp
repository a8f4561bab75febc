#include "runtime/pe/meter.hpp"

#include "runtime/core/cpu_clock.hpp"
#include "runtime/pe/interfaces/scope_listener.hpp"
#include "runtime/pe/measure/load_record.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/report/pe_watch.hpp"

#include <algorithm>

namespace tess::detail {
namespace {

constexpr std::uint64_t never = ~std::uint64_t{0};
constexpr double quantum_seconds = 1e-3;
constexpr double gap_seconds =
    30e-6;  // no step and no check of the queue for so long: the thread slept
constexpr double noise_seconds = 20e-6;  // the two clocks differ by as much without a reason

}  // namespace

Meter::Meter(Machine& machine, PeId pe)
    : machine_(machine),
      pe_(pe),
      virtual_(machine.virtual_time()),
      seconds_per_tick_(virtual_ ? 1e-9 : detail::seconds_per_tick()),
      made_(now()),
      since_(made_),
      step_began_(made_),
      quantum_ticks_(virtual_ ? never : ticks(quantum_seconds)),
      gap_ticks_(ticks(gap_seconds)) {}

void Meter::watch_enters(const Action* action) {
  watched_->measuring().watch()->enters(watched_->context().element, action);
}

void Meter::watch_leaves() {
  watched_->measuring().watch()->leaves();
}

bool Meter::is_balanced(const LoadRecord* record) {
  return record != nullptr && record->of_pe != nullptr;
}

std::uint64_t Meter::pass() {
  const std::uint64_t at = now(), spent = at - since_;
  if (scope_.record != nullptr) {
    scope_.record->spend(scope_.action, spent);
    in_records_ += spent;
  }
  if (spent > longest_ticks_) {  // also of what is no element's
    longest_ticks_ = spent;
    longest_ = scope_;
  }
  since_ = at;
  return at;
}

void Meter::sent(const ElementKey& to, std::uint64_t bytes) {
  scope_.record->sent.add(to, {bytes, 1});
}

void Meter::step_begins() {
  const std::uint64_t at = now();
  step_began_ = since_ = at;
  if (!virtual_ && at - last_seen_ > gap_ticks_) begin_quantum();
}

void Meter::step_ends() {
  const std::uint64_t at = pass();
  last_seen_ = at;
  if (at - quantum_began_ > quantum_ticks_) return quantum_passes(at);
  busy_ += at - step_began_;
}

void Meter::idle() {
  if (!virtual_) last_seen_ = now();
}

void Meter::begin_quantum() {
  // The thread may be preempted when this call returns; that time belongs to no call.
  cpu_at_begin_ = thread_cpu_seconds();
  quantum_began_ = since_ = step_began_ = now();
  busy_at_begin_ = busy_;
  longest_ = {};
  longest_ticks_ = 0;
}

void Meter::quantum_passes(std::uint64_t at) {
  busy_ += at - step_began_;
  end_quantum();
  begin_quantum();
}

/// What was stolen while it waited for messages is none of its busy time: so the CPU time is compared
/// with the busy part of the quantum.
void Meter::end_quantum() {
  const double stolen = seconds(busy_ - busy_at_begin_) - (thread_cpu_seconds() - cpu_at_begin_);
  if (!(stolen >= noise_seconds)) return;
  busy_ -= std::min(ticks(stolen), busy_ - busy_at_begin_);
  if (longest_.record == nullptr) return;
  const std::uint64_t back = std::min(ticks(stolen), longest_ticks_);
  LoadRecord& record = *longest_.record;
  in_records_ -= std::min(back, in_records_);
  record.in_run -= std::min(back, record.in_run);
  record.ticks -= std::min(back, record.ticks);
  if (record.of_pe != nullptr) *record.of_pe -= std::min(back, *record.of_pe);
  for (LoadRecord::MethodCost& entry : record.entries)
    if (entry.action == longest_.action) entry.ticks -= std::min(back, entry.ticks);
}

void Meter::add_alarm(std::uint64_t period, const void* owner, std::function<void()> ring) {
  alarms_.push_back({period, now() + period, owner, std::move(ring)});
  alarm_at_ = std::min(alarm_at_, alarms_.back().at);
}

void Meter::remove_alarms(const void* owner) {
  std::erase_if(alarms_, [owner](const Alarm& alarm) { return alarm.owner == owner; });
}

std::uint64_t Meter::in_balanced() const {
  std::uint64_t all = balanced_before_;
  for (const std::uint64_t* sum : balanced_) all += *sum;
  return all;
}

void Meter::remove_balanced(const std::uint64_t* sum) {
  balanced_before_ += *sum;
  std::erase(balanced_, sum);
}

void Meter::tell(std::uint64_t at) const {
  listener_->changed(at);
}

void Meter::ring(std::uint64_t at) {
  alarm_at_ = ~std::uint64_t{0};
  for (Alarm& alarm : alarms_) {
    const bool due = alarm.at <= at;
    if (due) alarm.at = at + alarm.period;
    alarm_at_ = std::min(alarm_at_, alarm.at);
    if (due) alarm.ring();
  }
}

}  // namespace tess::detail
