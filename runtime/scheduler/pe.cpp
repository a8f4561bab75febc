#include "runtime/scheduler/pe.hpp"

#include "runtime/core/check.hpp"
#include "runtime/messages/read_all.hpp"
#include "runtime/report/pe_watch.hpp"
#include "runtime/report/waiting.hpp"
#include "runtime/scheduler/auditing.hpp"
#include "runtime/scheduler/block.hpp"
#include "runtime/scheduler/element_mover.hpp"
#include "runtime/scheduler/idle_time.hpp"
#include "runtime/scheduler/outbox.hpp"
#include "runtime/scheduler/runtime.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

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

}  // namespace

Pe& current_pe() {
  TESS_CHECK(the_current_pe != nullptr,
             "this call belongs on a PE: into an entry method or the function given to run()");
  return *the_current_pe;
}

struct Pe::Tables {
  template <class Value>
  using ById = boost::unordered_flat_map<CollectionId, Value, std::hash<CollectionId>>;

  ById<std::unique_ptr<HostedCollection>> collections;
  ById<std::vector<Envelope*>> early;  // messages that arrived before their collection
};

/// A place is used again: the number of a future is its place, and above it how often the place had
/// been used before.
struct Pe::Futures {
  struct Place {
    void* future = nullptr;  // null: not in use
    std::uint32_t n_used = 0;
  };
  std::uint32_t first = 0;       // the number of the first place; above those of the run that a
                                 // restart continues
  std::vector<Place> places{1};  // the first is never used: no future has number 0
  std::vector<std::uint32_t> unused;
  std::vector<std::pair<std::uint64_t, void*>> before_restart;  // made meanwhile, by their numbers

  [[nodiscard]] Place* place_of(std::uint64_t id) {
    const auto number = static_cast<std::uint32_t>(id);
    if (number < first || number - first >= places.size()) return nullptr;
    Place& place = places[number - first];
    return place.future != nullptr && place.n_used == id >> 32U ? &place : nullptr;
  }
  /// Null if this number's future is no longer there.
  [[nodiscard]] void** find(std::uint64_t id) {
    if (Place* const place = place_of(id); place != nullptr) return &place->future;
    for (auto& [number, future] : before_restart)
      if (number == id && future != nullptr) return &future;
    return nullptr;
  }
};

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
      first_here_(machine.process_of(id).value * machine.pes_per_process()),
      n_here_(machine.pes_per_process()),
      bundle_ticks_(static_cast<std::uint64_t>(bundle_seconds / seconds_per_tick())),
      packed_ticks_(static_cast<std::uint64_t>(packed_seconds / seconds_per_tick())),
      futures_(std::make_unique<Futures>()),
      completion_messages_(*this),
      completion_(completion_messages_, id_, n_pes_),
      random_(mix(seed ^ mix(static_cast<std::uint64_t>(id.value)))),
      outbox_(std::make_unique<Outbox>(id, machine, messages, statistics_.bytes_sent)),
      bundles_(machine.takes_bundles() ? static_cast<std::size_t>(n_here_) : 0),
      tables_(std::make_unique<Tables>()) {}

Pe::~Pe() = default;

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
    outbox_->put(message);
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

void Pe::note_constructor(const std::string& name) {
  if (place_.empty()) place_ = runtime_.describe(*this) + " " + name;
}

void Pe::exception(const char* what, int exit_code) {
  note_place();
  const std::string place = std::exchange(place_, {});
  // Bad input is the user's to correct: one line without a trace. Everything else is a bug, so its
  // place is reported.
  if (exit_code == 2) {
    runtime_.error_line(text("error: ", one_line(what)));
  } else {
    runtime_.error_line(text("tessera: uncaught exception: ", what, "\n  ", place));
  }
  runtime_.exit(*this, exit_code);
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
  for (auto& [id, messages] : tables_->early) {
    for (Envelope* message : messages) discard(message);
  }
  tables_->early.clear();
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
  const auto at = tables_->collections.find(id);
  if (at == tables_->collections.end()) return nullptr;
  last_id_ = id;
  last_ = at->second.get();
  return last_;
}

void Pe::add(std::unique_ptr<HostedCollection> collection) {
  const CollectionId id = collection->id();
  TESS_CHECK(!tables_->collections.contains(id), id, " exists already on ", id_);
  tables_->collections.emplace(id, std::move(collection));
  last_id_ = CollectionId{~std::uint64_t{0}};
  const auto early = tables_->early.find(id);
  if (early == tables_->early.end()) return;
  const std::vector<Envelope*> messages = std::move(early->second);
  tables_->early.erase(early);
  for (Envelope* message : messages) send_here(message);
}

void Pe::keep_early(CollectionId id, Envelope* message, std::uint64_t (*drop)(Pe&, Envelope&)) {
  if (ended_.contains(id)) {
    const std::uint64_t n_lost = drop(*this, *message);
    if (CollectionNumbers::late_messages(id) == LateMessages::counted)
      statistics_.dead_letters += n_lost;
    discard(message);
    return;
  }
  tables_->early[id].push_back(message);
}

std::unique_ptr<HostedCollection> Pe::take_out(CollectionId id) {
  const auto at = tables_->collections.find(id);
  std::unique_ptr<HostedCollection> collection = std::move(at->second);
  tables_->collections.erase(at);
  last_id_ = CollectionId{~std::uint64_t{0}};
  ended_.add(id);
  return collection;
}

void Pe::keep_ending(std::unique_ptr<HostedCollection> collection, EpochId epoch) {
  ending_.push_back({std::move(collection), epoch});
}

Pe::Ending Pe::take_ending(CollectionId id) {
  const auto at = std::find_if(ending_.begin(), ending_.end(),
                               [id](const Ending& one) { return one.collection->id() == id; });
  Ending taken = std::move(*at);
  ending_.erase(at);
  return taken;
}

std::uint64_t Pe::enter_future(void* future) {
  if (futures_->unused.empty()) {
    futures_->unused.push_back(static_cast<std::uint32_t>(futures_->places.size()));
    futures_->places.emplace_back();
  }
  const std::uint32_t at = futures_->unused.back();
  futures_->unused.pop_back();
  Futures::Place& place = futures_->places[at];
  place.future = future;
  return std::uint64_t{place.n_used} << 32U | (futures_->first + at);
}

void Pe::move_future(std::uint64_t id, void* future) {
  if (void** const known = futures_->find(id)) *known = future;
}

void Pe::leave_future(std::uint64_t id) {
  if (Futures::Place* const place = futures_->place_of(id); place != nullptr) {
    place->future = nullptr;
    if (++place->n_used != 0)
      futures_->unused.push_back(static_cast<std::uint32_t>(id) - futures_->first);
  } else if (void** const known = futures_->find(id); known != nullptr) {
    *known = nullptr;
  }
}

void* Pe::find_future(std::uint64_t id) const {
  void** const known = futures_->find(id);
  return known == nullptr ? nullptr : *known;
}

std::uint32_t Pe::places_of_futures() const {
  return futures_->first + static_cast<std::uint32_t>(futures_->places.size());
}

void Pe::begin_futures_behind(std::uint32_t places) {
  Futures& now = *futures_;
  for (std::uint32_t at = 0; at < now.places.size(); ++at)
    if (const Futures::Place& place = now.places[at]; place.future != nullptr)
      now.before_restart.emplace_back(std::uint64_t{place.n_used} << 32U | (now.first + at),
                                      place.future);
  now.places.assign(1, {});
  now.unused.clear();
  now.first = places;
}

void* Pe::require_future(std::uint64_t id) const {
  void* const future = find_future(id);
  TESS_CHECK(future != nullptr || static_cast<std::uint32_t>(id) >= futures_->first,
             "a callback to a future of the run before the restart was called: make the future "
             "again after the restart, and send its new callback()");
  TESS_CHECK(future != nullptr,
             "the result of a future arrived after its coroutine had continued or ended: keep the "
             "future until its result is there");
  return future;
}

std::vector<HostedCollection*> Pe::collections() const {
  std::vector<HostedCollection*> all;
  for (const auto& [id, collection] : tables_->collections) all.push_back(collection.get());
  return all;
}

PeId Pe::forced_migration(const AfterMessage& after) {
  if (mover_ != nullptr) return mover_->move(after);
  if (migration_chance_ == 0 || !random_.chance(migration_chance_)) return id_;
  return PeId{static_cast<std::int32_t>(random_.below(static_cast<std::uint64_t>(n_pes_)))};
}

Waits Pe::census(std::span<void* const> except) const {
  Waits waits;
  const ElementWords& words = runtime_.element_words();
  for (const Suspended* at = suspended_.first(); at != nullptr; at = at->after) {
    const Suspended& one = *at;
    if (std::find(except.begin(), except.end(), one.frame) != except.end()) continue;
    NamedElement asker{"main", "the main program"};
    std::string state, code = "run()";
    if (one.element != nullptr) {
      asker = {words.key(*one.element), words.text(*one.element)};
      state = words.state(*one.element);
      if (one.action != nullptr) code = plain_name(one.action->name());
    }
    WaitReason reason = one.waits_for();
    waits.add(WaitRank::coroutine, text(asker.text, " on ", id_, state.empty() ? "" : ", ", state,
                                        ": ", code, " waits for ", reason.text));
    for (NamedElement& asked : reason.asked) waits.add_need({asker, std::move(asked)});
  }
  std::vector<std::string> lines;
  for (const auto& [id, collection] : tables_->collections) collection->describe_waiting(lines);
  for (std::string& line : lines) waits.add(WaitRank::collective, std::move(line));
  for (const Ending& one : ending_)
    waits.add(WaitRank::collective, text(one.collection->name(), " on ", id_,
                                         " was destroyed, but coroutines of its elements wait"));
  for (const auto& [id, messages] : tables_->early)
    waits.add(WaitRank::message, text(messages.size(), " messages on ", id_, " wait for ", id,
                                      ", which was never created"));
  lines.clear();
  completion_.describe_open(lines);
  for (std::string& line : lines) waits.add(WaitRank::epoch, std::move(line));
  return waits;
}

Waits Pe::census_of_running() const {
  Waits waits = census();
  std::size_t n_ready = 0;  // without those that end the run or ask for this census
  ready_.for_each(
      [&](const Link* one) { n_ready += static_cast<const Envelope*>(one)->counted ? 1U : 0U; });
  if (n_ready != 0)
    waits.add(WaitRank::queue,
              text(id_, n_ready == 1 ? ": 1 message is" : text(": ", n_ready, " messages are"),
                   " ready to run"));
  for (std::int32_t process = 0; process < machine_.n_processes(); ++process) {
    if (const std::size_t n = outbox_->n_waiting(ProcessId{process}); n != 0)
      waits.add(WaitRank::queue,
                text(id_, n == 1 ? ": 1 message waits" : text(": ", n, " messages wait"),
                     " for room to ", ProcessId{process}));
  }
  if (const std::size_t n = timers_.n_waiting(); n != 0)
    waits.add(WaitRank::queue,
              text(id_, n == 1 ? ": 1 timer is" : text(": ", n, " timers are"), " set"));
  return waits;
}

}  // namespace tess::detail
