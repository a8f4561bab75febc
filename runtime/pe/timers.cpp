#include "runtime/pe/timers.hpp"

#include "runtime/core/check.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/pe_action.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

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
void timer_call(Pe& pe, Due&& due) {
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

struct Timers::Tables {
  struct Once {
    Counted counted;
    RunHold hold;
    std::uint32_t led_by = 0;  // the broadcast that led to the timer, as in Context
    CollectionId led_in;
    Time due{0};
    Call call;
  };
  struct Periodic {
    Time period{0};
    Time due{0};
    Call call;
  };
  std::map<std::pair<Time, std::uint64_t>, Envelope*> waiting;
  std::vector<Time> alarms;  // under way, the earliest last
  std::unordered_map<std::uint64_t, Once> once;
  std::unordered_map<std::uint64_t, Periodic> periodic;
  bool frozen = false;
  std::vector<std::uint64_t> kept;  // timers whose tick came while they were frozen
};

Timers::Timers(Pe& pe) : pe_(pe), tables_(std::make_unique<Tables>()) {}
Timers::~Timers() {
  drop_all();
}

std::size_t Timers::n_waiting() const {
  return tables_->once.size();
}
std::size_t Timers::n_periodic() const {
  return tables_->periodic.size();
}

void Timers::drop_all() {
  for (const auto& [key, message] : tables_->waiting) discard(message);
  tables_->waiting.clear();
}

void Timers::wait(std::uint64_t timer, Time due, Envelope* message) {
  message->counted = false;
  tables_->waiting.emplace(std::pair(due, timer), message);
  set_alarm();
}

void Timers::stop_waiting(std::uint64_t timer, Time due) {
  const auto at = tables_->waiting.find({due, timer});
  if (at == tables_->waiting.end()) return;  // its message is in the queue
  discard(at->second);
  tables_->waiting.erase(at);
}

void Timers::set_alarm() {
  if (tables_->waiting.empty()) return;
  const Time due = tables_->waiting.begin()->first.first;
  if (!tables_->alarms.empty() && tables_->alarms.back() <= due) return;
  tables_->alarms.push_back(due);
  auto* const message = make_message<&alarm_rings>(pe_, Alarm{due.count()});
  message->source = pe_.id();
  message->counted = false;
  pe_.post_after(std::clamp(due - pe_.now(), Time(0), longest_alarm), message);
}

void Timers::on_alarm(Time at) {
  tables_->alarms.erase(std::find(tables_->alarms.begin(), tables_->alarms.end(), at));
  if (pe_.stopped()) return;
  while (!tables_->waiting.empty() && tables_->waiting.begin()->first.first <= pe_.now()) {
    const auto timer = tables_->waiting.extract(tables_->waiting.begin());
    pe_.put_uncounted(timer.mapped());
  }
  set_alarm();
}

std::uint64_t Timers::after(Time delay, Call call) {
  TESS_CHECK(delay >= Time(0), "a timer cannot wait for ", delay.count(), " ns");
  const Context& context = pe_.context();
  const Time due = after_now(pe_, delay);
  Completion& completion = pe_.completion();
  tables_->once.emplace(++n_made_,
                        Tables::Once{Counted::sent(completion, context.epoch), RunHold(completion),
                                     context.led_by, context.led_in, due, std::move(call)});
  wait(n_made_, due, pe_.stamp(make_message<&timer_call>(pe_, Due{n_made_})));
  return n_made_;
}

void Timers::on_due(std::uint64_t timer) {
  const auto at = tables_->once.find(timer);
  if (at == tables_->once.end() || pe_.stopped()) return;
  const Tables::Once due = std::move(at->second);  // moved out: the call may set timers
  tables_->once.erase(at);
  pe_.context().led_by = due.led_by;
  pe_.context().led_in = due.led_in;
  due.call();
}

void Timers::cancel(std::uint64_t timer) {
  if (const auto at = tables_->once.find(timer); at != tables_->once.end()) {
    stop_waiting(timer, at->second.due);
    tables_->once.erase(at);
  } else if (const auto tick = tables_->periodic.find(timer); tick != tables_->periodic.end()) {
    stop_waiting(timer, tick->second.due);
    tables_->periodic.erase(tick);
  }
}

std::uint64_t Timers::every(Time period, Call call) {
  TESS_CHECK(period > Time(0), "a timer cannot have a period of ", period.count(), " ns");
  const Time due = after_now(pe_, period);
  tables_->periodic.emplace(++n_made_, Tables::Periodic{period, due, std::move(call)});
  set_tick(n_made_, due);
  return n_made_;
}

void Timers::set_tick(std::uint64_t timer, Time due) {
  auto* const message = make_message<&timer_ticks>(pe_, Tick{timer});
  message->source = pe_.id();
  wait(timer, due, message);
}

void Timers::on_tick(std::uint64_t timer) {
  auto at = tables_->periodic.find(timer);
  if (at == tables_->periodic.end() || pe_.stopped()) return;
  if (tables_->frozen) {
    tables_->kept.push_back(timer);
    return;
  }
  // Moved out: the call may make timers, and may cancel this one.
  Call call = std::move(at->second.call);
  call();
  at = tables_->periodic.find(timer);
  if (at == tables_->periodic.end()) return;
  Tables::Periodic& of = at->second;
  of.call = std::move(call);
  const Time late = std::max(Time(0), pe_.now() - of.due);
  of.due += (late / of.period + 1) * of.period;
  set_tick(timer, of.due);
}

void Timers::freeze() {
  tables_->frozen = true;
}

void Timers::thaw() {
  tables_->frozen = false;
  for (const std::uint64_t timer : std::exchange(tables_->kept, {})) on_tick(timer);
}

void cancel_timer(PeId pe, std::uint64_t timer) {
  Pe& here = current_pe();
  if (pe.value >= here.n_pes()) return;  // of the run that a restart goes on with
  if (here.id() == pe)
    here.timers().cancel(timer);
  else
    send_system<&timer_is_cancelled>(here, pe, Cancel{timer});
}

}  // namespace tess::detail
