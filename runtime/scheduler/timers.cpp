#include "runtime/scheduler/timers.hpp"

#include "runtime/core/check.hpp"
#include "runtime/scheduler/pe.hpp"
#include "runtime/scheduler/pe_action.hpp"

#include <algorithm>
#include <utility>

namespace tess::detail {
namespace {

struct Due {
  std::uint64_t timer = 0;
};
struct Tick {
  std::uint64_t timer = 0;
};
struct Cancel {
  std::uint64_t timer = 0;
};

void timer_is_due(Pe& pe, Due&& due) {
  pe.timers().on_due(due.timer);
}
void timer_ticks(Pe& pe, Tick&& tick) {
  pe.timers().on_tick(tick.timer);
}
void timer_is_cancelled(Pe& pe, Cancel&& cancel) {
  pe.timers().cancel(cancel.timer);
}

}  // namespace

std::uint64_t Timers::after(Time delay, Call call) {
  TESS_CHECK(delay >= Time(0), "a timer cannot wait for ", delay.count(), " ns");
  const EpochId epoch = pe_.context().epoch;
  once_.emplace(++n_made_, Once{epoch, std::move(call)});
  pe_.completion().sent(epoch);
  pe_.completion().hop_sent();
  auto* const message = pe_.stamp(make_message<&timer_is_due>(pe_, Due{n_made_}));
  message->counted = false;
  pe_.post_after(delay, message);
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
    once_.erase(at);
  } else {
    periodic_.erase(timer);
  }
}

std::uint64_t Timers::every(Time period, Call call) {
  TESS_CHECK(period > Time(0), "a timer cannot have a period of ", period.count(), " ns");
  const Time due = pe_.now() + period;
  periodic_.emplace(++n_made_, Periodic{period, due, std::move(call)});
  set_tick(n_made_, due);
  return n_made_;
}

void Timers::set_tick(std::uint64_t timer, Time due) {
  auto* const message = make_message<&timer_ticks>(pe_, Tick{timer});
  message->source = pe_.id();
  message->counted = false;
  pe_.post_after(std::max(Time(0), due - pe_.now()), message);
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
