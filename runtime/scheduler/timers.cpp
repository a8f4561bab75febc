#include "runtime/scheduler/timers.hpp"

#include "runtime/core/check.hpp"
#include "runtime/scheduler/pe.hpp"
#include "runtime/scheduler/pe_action.hpp"

#include <algorithm>
#include <utility>

namespace tess::detail {
namespace {

/// A timer that runs once; its message never leaves the process.
struct Expiry {
  Timers::Call call;
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    TESS_CHECK(false, "a timer cannot leave its PE");
  }
};
struct Tick {
  std::uint64_t timer = 0;
};
struct Cancel {
  std::uint64_t timer = 0;
};

void timer_expires(Pe& pe, Expiry&& expiry) {
  pe.timers().on_expired(expiry.call);
}
void timer_ticks(Pe& pe, Tick&& tick) {
  pe.timers().on_tick(tick.timer);
}
void timer_is_cancelled(Pe& pe, Cancel&& cancel) {
  pe.timers().cancel(cancel.timer);
}

}  // namespace

void Timers::after(Time delay, Call call) {
  TESS_CHECK(delay >= Time(0), "a timer cannot wait for ", delay.count(), " ns");
  ++n_waiting_;
  pe_.completion().sent(pe_.context().epoch);
  pe_.send_after(delay, pe_.stamp(make_message<&timer_expires>(pe_, Expiry{std::move(call)})));
}

void Timers::on_expired(const Call& call) {
  --n_waiting_;
  const EpochId epoch = pe_.context().epoch;
  call();
  pe_.completion().processed(epoch);
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
