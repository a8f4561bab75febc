#include "runtime/scheduler/timers.hpp"

#include "runtime/core/check.hpp"
#include "runtime/scheduler/pe.hpp"
#include "runtime/scheduler/pe_action.hpp"

#include <algorithm>
#include <utility>

namespace tess::detail {
namespace {

/// A later timer gets more than one: the machine adds the delay to a clock of its own.
constexpr Time longest_alarm = std::chrono::hours(24 * 365);

struct Alarm {
  std::int64_t at_ns = 0;
};
struct Due {
  std::uint64_t timer = 0;
};
struct Tick {
  std::uint64_t timer = 0;
};
struct Cancel {
  std::uint64_t timer = 0;
};

void alarm_rings(Pe& pe, Alarm&& alarm) {
  pe.timers().on_alarm(Time(alarm.at_ns));
}
void timer_is_due(Pe& pe, Due&& due) {
  pe.timers().on_due(due.timer);
}
void timer_ticks(Pe& pe, Tick&& tick) {
  pe.timers().on_tick(tick.timer);
}
void timer_is_cancelled(Pe& pe, Cancel&& cancel) {
  pe.timers().cancel(cancel.timer);
}

/// The end of a delay from now; the clock's last time for one that is longer.
Time after_now(Pe& pe, Time delay) {
  const Time now = pe.now();
  return delay < Time::max() - now ? now + delay : Time::max();
}

}  // namespace

void Timers::drop_all() {
  for (const auto& [key, message] : waiting_) discard(message);
  waiting_.clear();
}

void Timers::wait(std::uint64_t timer, Time due, Envelope* message) {
  message->counted = false;
  waiting_.emplace(std::pair(due, timer), message);
  set_alarm();
}

void Timers::stop_waiting(std::uint64_t timer, Time due) {
  const auto at = waiting_.find({due, timer});
  if (at == waiting_.end()) return;  // its message is in the queue
  discard(at->second);
  waiting_.erase(at);
}

void Timers::set_alarm() {
  if (waiting_.empty()) return;
  const Time due = waiting_.begin()->first.first;
  if (!alarms_.empty() && alarms_.back() <= due) return;
  alarms_.push_back(due);
  auto* const message = make_message<&alarm_rings>(pe_, Alarm{due.count()});
  message->source = pe_.id();
  message->counted = false;
  pe_.post_after(std::clamp(due - pe_.now(), Time(0), longest_alarm), message);
}

void Timers::on_alarm(Time at) {
  alarms_.erase(std::find(alarms_.begin(), alarms_.end(), at));
  if (pe_.stopped()) return;
  while (!waiting_.empty() && waiting_.begin()->first.first <= pe_.now()) {
    const auto timer = waiting_.extract(waiting_.begin());
    pe_.send_uncounted(pe_.id(), timer.mapped());
  }
  set_alarm();
}

std::uint64_t Timers::after(Time delay, Call call) {
  TESS_CHECK(delay >= Time(0), "a timer cannot wait for ", delay.count(), " ns");
  const EpochId epoch = pe_.context().epoch;
  const Time due = after_now(pe_, delay);
  once_.emplace(++n_made_, Once{epoch, due, std::move(call)});
  pe_.completion().sent(epoch);
  pe_.completion().hop_sent();
  wait(n_made_, due, pe_.stamp(make_message<&timer_is_due>(pe_, Due{n_made_})));
  return n_made_;
}

void Timers::on_due(std::uint64_t timer) {
  const auto at = once_.find(timer);
  if (at == once_.end() || pe_.stopped()) return;
  const Once due = std::move(at->second);  // moved out: the call may set timers
  once_.erase(at);
  due.call();
  pe_.completion().processed(due.epoch);
  pe_.completion().hop_processed();
}

void Timers::cancel(std::uint64_t timer) {
  if (const auto at = once_.find(timer); at != once_.end()) {
    pe_.completion().processed(at->second.epoch);
    pe_.completion().hop_processed();
    stop_waiting(timer, at->second.due);
    once_.erase(at);
  } else if (const auto tick = periodic_.find(timer); tick != periodic_.end()) {
    stop_waiting(timer, tick->second.due);
    periodic_.erase(tick);
  }
}

std::uint64_t Timers::every(Time period, Call call) {
  TESS_CHECK(period > Time(0), "a timer cannot have a period of ", period.count(), " ns");
  const Time due = after_now(pe_, period);
  periodic_.emplace(++n_made_, Periodic{period, due, std::move(call)});
  set_tick(n_made_, due);
  return n_made_;
}

void Timers::set_tick(std::uint64_t timer, Time due) {
  auto* const message = make_message<&timer_ticks>(pe_, Tick{timer});
  message->source = pe_.id();
  wait(timer, due, message);
}

void Timers::on_tick(std::uint64_t timer) {
  auto at = periodic_.find(timer);
  if (at == periodic_.end() || pe_.stopped()) return;
  if (frozen_) {
    kept_.push_back(timer);
    return;
  }
  // Moved out: the call may make timers, and may cancel this one.
  Call call = std::move(at->second.call);
  call();
  at = periodic_.find(timer);
  if (at == periodic_.end()) return;
  Periodic& of = at->second;
  of.call = std::move(call);
  const Time late = std::max(Time(0), pe_.now() - of.due);
  of.due += (late / of.period + 1) * of.period;
  set_tick(timer, of.due);
}

std::size_t Timers::freeze() {
  frozen_ = true;
  return periodic_.size();
}

void Timers::thaw() {
  frozen_ = false;
  for (const std::uint64_t timer : std::exchange(kept_, {})) on_tick(timer);
}

void cancel_timer(PeId pe, std::uint64_t timer) {
  Pe& here = current_pe();
  if (here.id() == pe)
    here.timers().cancel(timer);
  else
    send_system<&timer_is_cancelled>(here, pe, Cancel{timer});
}

}  // namespace tess::detail
