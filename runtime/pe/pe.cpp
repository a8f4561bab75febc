#include "runtime/pe/pe.hpp"

#include "runtime/core/check.hpp"
#include "runtime/pe/auditing.hpp"
#include "runtime/pe/block.hpp"
#include "runtime/pe/interfaces/element_mover.hpp"
#include "runtime/pe/measure/idle_time.hpp"
#include "runtime/pe/queues/outbox.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/pe/tables/collection_table.hpp"
#include "runtime/pe/tables/future_table.hpp"
#include "runtime/watch/report/pe_watch.hpp"
#include "runtime/wire/messages/read_all.hpp"

#include <algorithm>
#include <new>
#include <utility>

namespace tess::detail {
namespace {

/// The longest time that a message waits for others to the same PE of this process, or to another
/// process.
constexpr double bundle_seconds = 1e-6;
constexpr double packed_seconds = 4e-6;
/// The most messages between two readings of the clock, if messages are held back and short.
constexpr std::uint32_t most_between_looks = 8;
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
      first_here_(machine.first_pe(machine.process_of(id)).value),
      n_here_(machine.pes_per_process()),
      bundle_ticks_(static_cast<std::uint64_t>(bundle_seconds / seconds_per_tick())),
      packed_ticks_(static_cast<std::uint64_t>(packed_seconds / seconds_per_tick())),
      futures_(std::make_unique<FutureTable>()),
      completion_messages_(*this),
      completion_(completion_messages_, id_, n_pes_),
      random_(mix(seed ^ mix(static_cast<std::uint64_t>(id.value)))),
      outbox_(std::make_unique<Outbox>(id, machine, messages, statistics_.bytes_sent)),
      bundles_(machine.takes_bundles() ? static_cast<std::size_t>(n_here_) : 0),
      collection_table_(std::make_unique<CollectionTable>()) {}

Pe::~Pe() {
  for (const HostedCollection* collection : collection_table_->all()) {
    ends_with_run = collection;
    const auto ending = collection_table_->take_out(collection->id());
  }
  ends_with_run = nullptr;
}

void Pe::hold() {
  if (holds_) return;
  holds_ = true;
  held_since_ = last_look_ = read_ticks();
  until_look_ = look_every_ = 1;
}

void Pe::accept(Link* first) {
  if (audit_) [[unlikely]]
    audit_arrivals(first);
  for (Link* next = nullptr; first != nullptr; first = next) {
    next = first->next;
    enqueue(static_cast<Envelope*>(first));
  }
}

void Pe::keep_exception(std::exception_ptr error) {
  note_place();
  if (!kept_exception_) kept_exception_ = std::move(error);
}

void Pe::count(const Envelope& message) {
  Counted::departs(completion_, message.epoch);
}

void Pe::set_forced_migrations(double chance, ElementMover* mover) {
  migration_chance_ = chance;
  mover_ = mover;
}

CollectionId Pe::new_collection_id(LateMessages late) {
  return collection_numbers_.next(id_, late);
}

Meter& Pe::start_meter() {
  measures_briefly_ = false;
  if (!meter_)
    meter_ = idle_meter_ ? std::move(idle_meter_) : std::make_unique<Meter>(machine_, id_);
  return *meter_;
}
Meter& Pe::start_brief_meter() {
  const bool briefly = measures_briefly_ || !meter_;
  Meter& meter = start_meter();
  measures_briefly_ = briefly;
  return meter;
}
void Pe::stop_brief_meter() {
  if (measures_briefly_) idle_meter_ = std::move(meter_);
  measures_briefly_ = false;
}
void Pe::forget(const LoadRecord& record) {
  for (Meter* meter : {meter_.get(), idle_meter_.get()})
    if (meter != nullptr) meter->forget(&record);
}
void Pe::start_trace(std::size_t most_records) {
  start_meter();
  trace_ = std::make_unique<Trace>(most_records);
}

void Pe::carry(PeId to, Envelope* message) {
  if (to == id_ && !intercepts_) {
    enqueue(message);
  } else if (static_cast<std::uint32_t>(to.value - first_here_) <
             static_cast<std::uint32_t>(n_here_)) {
    ++statistics_.sent_remote;
    pass(to, message, sizeof(Envelope));
  } else {
    ++statistics_.sent_remote;
    try {
      outbox_->put(message);
    } catch (...) {  // serialize() of an argument threw; the message counts as sent already
      keep_exception(std::current_exception());
    }
    if (outbox_->holds()) hold();
  }
}

void Pe::route(PeId to, Envelope* message) {
  message->target = to;
  if (audit_ && !audit_departure(to, message)) [[unlikely]]
    return;
  carry(to, message);
}

void Pe::post_after(Time delay, Envelope* message) {
  message->target = id_;
  if (!machine_.post_after(id_, message, delay)) runtime_.post_after(id_, message, delay);
}

void Pe::pass(PeId to, Envelope* message, std::size_t n_bytes) {
  if (bundles_.empty()) {
    machine_.post(id_, to, message, n_bytes, message->action->traffic);
    return;
  }
  Bundle*& bundle = bundles_[static_cast<std::size_t>(to.value - first_here_)];
  if (bundle == nullptr) bundle = new (allocate_block(*this, sizeof(Bundle))) Bundle;
  if (bundle->n == 0) opened_.push_back(to.value - first_here_);
  bundle->messages[bundle->n++] = message;
  if (message->prioritised) [[unlikely]]
    bundle->prioritised = true;
  if (bundle->n == Bundle::capacity) post(bundle, to);
  hold();
}

void Pe::post(Bundle*& bundle, PeId to) {
  if (bundle->n == 1) {  // posted alone; the bundle is kept for later messages
    auto* const message = static_cast<Envelope*>(bundle->messages[0]);
    bundle->n = 0;
    bundle->prioritised = false;
    machine_.post(id_, to, message, sizeof(Envelope), message->action->traffic);
  } else {
    machine_.post_bundle(to, std::exchange(bundle, nullptr));
  }
}

void Pe::accept(Bundle* bundle) {
  if (audit_) [[unlikely]] {
    for (std::uint32_t i = 0; i < bundle->n; ++i)
      audit_arrival(static_cast<Envelope*>(bundle->messages[i]));
  }
  if (bundle->prioritised) [[unlikely]] {
    for (std::uint32_t i = 0; i < bundle->n; ++i)
      enqueue(static_cast<Envelope*>(bundle->messages[i]));
  } else {
    for (std::uint32_t i = 0; i < bundle->n; ++i) ready_.push(bundle->messages[i]);
  }
  Pool::release(bundle, &pool_);
}

/// Runs a message that may take long: messages sent before it leave first.
void Pe::run_slow(Envelope* message, const Action& action) {
  flush();
  const std::uint64_t begin = read_ticks();
  run_one(message);
  const bool quick = read_ticks() - begin < bundle_ticks_;
  action.set_pace(quick ? Action::Pace::quick : Action::Pace::slow);
}

/// Called after a message of this action, if messages are held back.
void Pe::look_at_clock(const Action& action) {
  const std::uint64_t now = read_ticks();
  if (now - last_look_ > bundle_ticks_) {
    if (look_every_ == 1) action.set_pace(Action::Pace::slow);
    look_every_ = 1;
  } else {
    look_every_ = std::min(2 * look_every_, most_between_looks);
  }
  until_look_ = look_every_;
  last_look_ = now;
  if (now - held_since_ > packed_ticks_) {
    flush();
  } else if (now - held_since_ > bundle_ticks_) {
    flush_bundles();
    holds_ = outbox_->holds();
  }
}

void Pe::flush_bundles() {
  for (const std::int32_t at : opened_) {
    Bundle*& bundle = bundles_[static_cast<std::size_t>(at)];
    if (bundle != nullptr && bundle->n != 0) post(bundle, PeId{first_here_ + at});
  }
  opened_.clear();
}

bool Pe::flush() {
  if (!holds_) return false;
  holds_ = false;
  flush_bundles();
  outbox_->flush();
  return true;
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
    if (kept_exception_) [[unlikely]]
      std::rethrow_exception(std::exchange(kept_exception_, nullptr));
  } catch (const Error& error) {
    exception(error.what(), 2);
  } catch (const std::bad_alloc&) {
    kept_exception_ = nullptr;
    completion_.stop_reporting();
    runtime_.out_of_memory(*this, std::exchange(place_, {}));
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
    repay(sender,
          charge);  // before it counts as processed: the run is not over while credit is due
  if (counted) completion_.hop_processed();
}

void Pe::run_one(Envelope* message) {
  if (trace_) [[unlikely]] {
    run_traced(message);
  } else {
    run(message);
  }
}

void Pe::run_traced(Envelope* message) {
  const Action* action = message->action;
  const PeId source = message->source;
  const std::uint32_t number = message->trace;
  const std::uint64_t begin = meter_->now();
  meter_->forget_entered();
  trace_->begins();
  run(message);
  if (meter_->entered() != nullptr) action = meter_->entered();
  trace_->ran(action, begin, meter_->now(), source, number);
}

void Pe::note_place() {
  if (place_.empty()) place_ = runtime_.describe(*this);
}

void Pe::note_place(std::string_view instead) {
  if (place_.empty()) place_ = text("on ", id_, ", ", instead);
}

void Pe::note_constructor(std::string_view of, std::initializer_list<std::string_view> types) {
  if (!place_.empty()) return;
  place_ = runtime_.describe(*this) + " " + plain_name(of) + "(";
  for (const std::string_view& type : types)
    place_ += (&type == types.begin() ? "" : ", ") + plain_name(type);
  place_ += ")";
}

void Pe::exception(const char* what, int exit_code) {
  kept_exception_ = nullptr;
  completion_.stop_reporting();
  note_place();
  const std::string place = std::exchange(place_, {});
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
  if (idle_time_ && idle_time_->idle()) [[unlikely]]
    idle_time_->end(now());
  const RunsOn here(*this);
  std::size_t n = 0;
  if (meter_) [[unlikely]]
    meter_->step_begins();
  for (; n < most && !ready_.empty(); ++n) {
    auto* const message = static_cast<Envelope*>(ready_.pop());
    const Action& action = *message->action;
    if (const auto* soon = static_cast<const Envelope*>(ready_.ahead(2)); soon != nullptr)
      __builtin_prefetch(soon->receiver, 1);
    if (holds_ && !action.quick()) [[unlikely]] {
      run_slow(message, action);
    } else {
      run_one(message);
    }
    if (holds_ && --until_look_ == 0) look_at_clock(action);
  }
  statistics_.messages += n;
  idle_calls_ = 0;
  messages_since_report_ += n;
  if (messages_since_report_ >= messages_between_reports) {
    messages_since_report_ = 0;
    completion_.report_epochs();
  }
  if (n <= few_messages) flush();
  if (meter_) [[unlikely]]
    meter_->step_ends();
  // The simulated cost of messages is not load: a balancer must not see it as background.
  if (message_cost_.count() != 0) machine_.charge(id_, message_cost_ * n);
  return n;
}

void Pe::start_idle_time() {
  idle_time_ = std::make_unique<IdleTime>();
}

// An epoch must end also while other work keeps this PE from being idle.
void Pe::busy() {
  const RunsOn here(*this);
  messages_since_report_ = 0;
  if (completion_.report_epochs()) flush();
}

bool Pe::idle() {
  const RunsOn here(*this);
  if (meter_) [[unlikely]]
    meter_->idle();
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
  const bool works = flush() || busy || !ready_.empty();
  if (idle_time_ && !works) [[unlikely]]
    idle_time_->begin(now());
  return works;
}

void Pe::drop_all() {
  while (!ready_.empty()) discard(static_cast<Envelope*>(ready_.pop()));
  for (Envelope* message : collection_table_->take_all_early()) discard(message);
  for (Bundle*& bundle : bundles_) {
    if (bundle == nullptr) continue;
    for (std::uint32_t i = 0; i < bundle->n; ++i)
      discard(static_cast<Envelope*>(bundle->messages[i]));
    Pool::release(std::exchange(bundle, nullptr), &pool_);
  }
  outbox_->drop_all();
  timers_.drop_all();
  dropping_ = true;
  end_all(suspended_);
}

HostedCollection* Pe::find_slow(CollectionId id) {
  HostedCollection* const collection = collection_table_->find(id);
  if (collection == nullptr) return nullptr;
  last_id_ = id;
  last_ = collection;
  return collection;
}

void Pe::add(std::unique_ptr<HostedCollection> collection) {
  const CollectionId id = collection->id();
  TESS_CHECK(collection_table_->find(id) == nullptr, id, " exists already on ", id_);
  last_id_ = CollectionId{~std::uint64_t{0}};
  for (Envelope* message : collection_table_->add(std::move(collection))) send_here(message);
}

void Pe::keep_early(CollectionId id, Envelope* message, std::uint64_t (*drop)(Pe&, Envelope&)) {
  if (ended_.contains(id)) {
    const std::uint64_t n_lost = drop(*this, *message);
    if (CollectionNumbers::late_messages(id) == LateMessages::counted)
      statistics_.dead_letters += n_lost;
    discard(message);
    return;
  }
  collection_table_->keep_early(id, message);
}

void Pe::keep_early_join(CollectionId id, std::uint32_t round) {
  if (!ended_.contains(id)) collection_table_->keep_early_join(id, round);
}
std::vector<std::uint32_t> Pe::take_early_joins(CollectionId id) {
  return collection_table_->take_early_joins(id);
}

std::unique_ptr<HostedCollection> Pe::take_out(CollectionId id) {
  std::unique_ptr<HostedCollection> collection = collection_table_->take_out(id);
  last_id_ = CollectionId{~std::uint64_t{0}};
  ended_.add(id);
  return collection;
}

void Pe::keep_ending(std::unique_ptr<HostedCollection> collection, Counted end) {
  ending_.push_back({{}, std::move(collection)});
  ending_.back().ends.push_back(std::move(end));
}

std::vector<Pe::Ending>::iterator Pe::find_ending(CollectionId id) {
  return std::find_if(ending_.begin(), ending_.end(),
                      [id](const Ending& one) { return one.collection->id() == id; });
}

void Pe::await_ending(CollectionId id, Counted&& end) {
  if (const auto at = find_ending(id); at != ending_.end()) at->ends.push_back(std::move(end));
}

Pe::Ending Pe::take_ending(CollectionId id) {
  const auto at = find_ending(id);
  Ending taken = std::move(*at);
  ending_.erase(at);
  return taken;
}

std::uint64_t Pe::enter_future(void* future) {
  return futures_->enter(future);
}
void Pe::move_future(std::uint64_t id, void* future) {
  futures_->move(id, future);
}
void Pe::leave_future(std::uint64_t id) {
  futures_->leave(id);
}
void* Pe::find_future(std::uint64_t id) const {
  return futures_->find(id);
}
void* Pe::require_future(std::uint64_t id) const {
  return futures_->require(id);
}
std::uint32_t Pe::places_of_futures() const {
  return futures_->n_places();
}
bool Pe::has_futures() const {
  return !futures_->empty();
}
void Pe::begin_futures_behind(std::uint32_t places) {
  futures_->begin_behind(places);
}

std::vector<HostedCollection*> Pe::collections() const {
  return collection_table_->all();
}

PeId Pe::forced_migration(const AfterMessage& after) {
  if (mover_ != nullptr) return mover_->move(after);
  if (migration_chance_ == 0 || !random_.chance(migration_chance_)) return id_;
  return PeId{static_cast<std::int32_t>(random_.below(static_cast<std::uint64_t>(n_pes_)))};
}

}  // namespace tess::detail
