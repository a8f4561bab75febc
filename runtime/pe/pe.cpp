#include "runtime/pe/pe.hpp"

#include "runtime/core/check.hpp"
#include "runtime/pe/measure/idle_time.hpp"
#include "runtime/pe/message_audit.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/wire/messages/read_all.hpp"

#include <new>
#include <string>
#include <utility>

namespace tess::detail {
namespace {

/// After a step of so few messages more are unlikely to follow soon: packed messages are sent.
constexpr std::size_t few_messages = 2;
/// A PE that is never idle reports its epochs after so many messages.
constexpr std::size_t messages_between_reports = 1024;

/// The collection whose elements are destroyed because the run is over; null if there is none.
thread_local const HostedCollection* ends_with_run = nullptr;

std::string no_pe_text() {
  if (ends_with_run == nullptr)
    return "this call belongs on a PE: into an entry method or the function given to run()";
  return text(
      "the destructor of ", ends_with_run->name(),
      " calls the runtime after the end of the run: destroy() the array or group before, or "
      "send from an entry method");
}

}  // namespace

Pe& current_pe() {
  TESS_CHECK(the_current_pe != nullptr, no_pe_text());
  return *the_current_pe;
}

Pe::Pe(PeId id, Runtime& runtime, Machine& machine, Pool& pool, std::uint64_t seed,
       const MessageOptions& messages)
    : id_(id),
      n_pes_(machine.n_pes()),
      runtime_(runtime),
      machine_(machine),
      pool_(pool),
      intercepts_(machine.intercepts_local()),
      patience_(machine.patience()),
      message_cost_(machine.message_cost()),
      completion_(completion_messages_, id_, n_pes_),
      forced_migrations_(n_pes_, mix(seed ^ mix(static_cast<std::uint64_t>(id.value)))),
      peers_(*this, messages) {}

Pe::~Pe() {
  for (const HostedCollection* collection : collections_.all()) {
    ends_with_run = collection;
    const auto ending = collections_.take_out(collection->id());
  }
  ends_with_run = nullptr;
}

void Pe::accept(Link* first) {
  if (MessageAudit* const audit = measuring_.audit()) [[unlikely]] {
    for (Link* one = first; one != nullptr; one = one->next)
      audit->arrives(*static_cast<Envelope*>(one));
  }
  for (Link* next = nullptr; first != nullptr; first = next) {
    next = first->next;
    enqueue(static_cast<Envelope*>(first));
  }
}

void Pe::count(const Envelope& message) {
  Counted::departs(completion_, message.epoch);
}

void Pe::carry(PeId to, Envelope* message) {
  if (to == id_ && !intercepts_) {
    enqueue(message);
  } else {
    ++statistics_.sent_remote;
    if (peers_.in_process(to)) {
      peers_.pass(to, message, sizeof(Envelope));
    } else {
      peers_.pack(message);
    }
  }
}

void Pe::route(PeId to, Envelope* message) {
  message->target = to;
  if (MessageAudit* const audit = measuring_.audit()) [[unlikely]] {
    const MessageFault::Kind fault = audit->departs(to, *message);
    if (fault == MessageFault::Kind::lost) return discard(message);
    if (fault == MessageFault::Kind::twice) carry(to, MessageAudit::copy_of(*this, *message));
  }
  carry(to, message);
}

void Pe::hand_over(Envelope* message, std::size_t n_bytes) {
  if (message->target == id_) {
    if (MessageAudit* const audit = measuring_.audit()) [[unlikely]]
      audit->arrives(*message);
    enqueue(message);
  } else {
    peers_.pass(message->target, message, n_bytes);
  }
}

void Pe::post_after(Time delay, Envelope* message) {
  message->target = id_;
  if (!machine_.post_after(id_, message, delay)) runtime_.post_after(id_, message, delay);
}

void Pe::accept(Bundle* bundle) {
  if (MessageAudit* const audit = measuring_.audit()) [[unlikely]] {
    for (std::uint32_t i = 0; i < bundle->n; ++i)
      audit->arrives(*static_cast<Envelope*>(bundle->messages[i]));
  }
  if (bundle->prioritised) [[unlikely]] {
    for (std::uint32_t i = 0; i < bundle->n; ++i)
      enqueue(static_cast<Envelope*>(bundle->messages[i]));
  } else {
    for (std::uint32_t i = 0; i < bundle->n; ++i) ready_.push(bundle->messages[i]);
  }
  Pool::release(bundle, &pool_);
}

void Pe::run(Envelope* message) {
  const bool counted = message->counted;
  if (stopped_ && counted) [[unlikely]] {
    discard(message);
    return;
  }
  const std::uint32_t charge = message->charge;
  const PeId sender = message->sender;
  message->charge = 0;  // it is paid, wherever it goes next
  // Assigned member by member: a copy of a context that was just written would stall.
  begins(message->action);
  of_message_.epoch = message->epoch;
  try {
    message->action->run(*this, message);
    error_.rethrow();
  } catch (const Error& error) {
    exception(error.what(), 2);
  } catch (const std::bad_alloc&) {
    completion_.stop_reporting();
    runtime_.out_of_memory(*this, error_.take());
  } catch (const std::exception& error) {
    exception(error.what(), 1);
  } catch (...) {
    exception("an exception that is not a std::exception", 1);
  }
  of_message_.element = nullptr;
  begins(nullptr);
  of_message_.epoch = EpochId{};
  of_message_.led_by = 0;
  if (charge != 0) [[unlikely]]
    peers_.repay(sender,
                 charge);  // before it counts as processed: the run is not over while credit is due
  if (counted) completion_.hop_processed();
}

void Pe::run_one(Envelope* message) {
  if (measuring_.trace() != nullptr) [[unlikely]] {
    run_traced(message);
  } else {
    run(message);
  }
}

void Pe::run_traced(Envelope* message) {
  const Action* action = message->action;
  const PeId source = message->source;
  const std::uint32_t number = message->trace;
  Meter& meter = *measuring_.meter();
  Trace& trace = *measuring_.trace();
  const std::uint64_t begin = meter.now();
  meter.forget_entered();
  trace.begins();
  run(message);
  if (meter.entered() != nullptr) action = meter.entered();
  trace.ran(action->id(), begin, meter.now(), source, number);
}

void Pe::exception(const char* what, int exit_code) {
  completion_.stop_reporting();
  error_.note_place();
  const std::string place = error_.take();
  // Bad input is the user's to correct: one line without a trace. Everything else is a bug, so its
  // place is reported.
  if (exit_code == 2) {
    runtime_.bad_input(*this, what);
  } else {
    runtime_.error_line(text("tessera: uncaught exception: ", what, "\n  ", place));
    runtime_.exit(*this, exit_code);
  }
}

std::size_t Pe::step(std::size_t most) {
  if (ready_.empty()) return 0;
  if (IdleTime* const idle_time = measuring_.idle_time(); idle_time != nullptr && idle_time->idle())
      [[unlikely]]
    idle_time->end(now());
  const RunsOn here(*this);
  std::size_t n = 0;
  if (meter() != nullptr) [[unlikely]]
    meter()->step_begins();
  for (; n < most && !ready_.empty(); ++n) {
    auto* const message = static_cast<Envelope*>(ready_.pop());
    const Action& action = *message->action;
    if (const auto* soon = static_cast<const Envelope*>(ready_.ahead(2)); soon != nullptr)
      __builtin_prefetch(soon->receiver, 1);
    if (peers_.holds() && !action.quick()) [[unlikely]] {
      const std::uint64_t began = peers_.before_slow();
      run_one(message);
      peers_.slow_ran(action, began);
    } else {
      run_one(message);
    }
    if (peers_.holds()) peers_.ran(action);
  }
  statistics_.messages += n;
  idle_calls_ = 0;
  messages_since_report_ += n;
  if (messages_since_report_ >= messages_between_reports) {
    messages_since_report_ = 0;
    completion_.report_epochs();
  }
  if (n <= few_messages) peers_.flush();
  if (meter() != nullptr) [[unlikely]]
    meter()->step_ends();
  // The simulated cost of messages is not load: a balancer must not see it as background.
  if (message_cost_.count() != 0) machine_.charge(id_, message_cost_ * n);
  return n;
}

// An epoch must end also while other work keeps this PE from being idle.
void Pe::busy() {
  const RunsOn here(*this);
  messages_since_report_ = 0;
  if (completion_.report_epochs()) peers_.flush();
}

bool Pe::idle() {
  const RunsOn here(*this);
  if (meter() != nullptr) [[unlikely]]
    meter()->idle();
  messages_since_report_ = 0;
  bool busy = completion_.report_epochs();
  // Epoch 0 is reported only after all scoped epochs, whose reports belong to no message: the run
  // is over only if none is due. Also not at the first gap: a PE that is idle between two messages
  // of a ping-pong would report each time. Until then it claims to be busy, since the machine may
  // let an idle PE sleep without limit.
  if (busy) {
    ++idle_calls_;
  } else if (completion_.run_changed()) {
    busy = ++idle_calls_ < patience_ || completion_.report_run();
  } else {
    pool_.flush();
  }
  const bool works = peers_.flush() || busy || !ready_.empty();
  if (IdleTime* const idle_time = measuring_.idle_time(); idle_time != nullptr && !works)
      [[unlikely]]
    idle_time->begin(now());
  return works;
}

void Pe::drop_all() {
  while (!ready_.empty()) discard(static_cast<Envelope*>(ready_.pop()));
  collections_.drop_all();
  peers_.drop_all();
  timers_.drop_all();
  dropping_ = true;
  end_all(suspended_);
}

}  // namespace tess::detail
