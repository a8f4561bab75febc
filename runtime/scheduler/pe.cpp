#include "runtime/scheduler/pe.hpp"

#include "runtime/check.hpp"
#include "runtime/collections/collection.hpp"
#include "runtime/scheduler/runtime.hpp"

#include <new>

namespace tess {
namespace {

/// After a step of so few messages no others are likely to follow soon: what was packed leaves.
constexpr std::size_t few_messages = 2;
/// A PE that never runs dry reports its epochs after so many messages.
constexpr std::size_t messages_between_reports = 1024;

}  // namespace

Pe& current_pe() {
  TESS_CHECK(detail::the_current_pe != nullptr,
             "this call belongs on a PE: into an entry method or the function given to run()");
  return *detail::the_current_pe;
}

Pe::Pe(PeId id,
       Runtime& runtime,
       Machine& machine,
       Pool& pool,
       std::uint64_t seed,
       const MessageOptions& messages)
    : id_(id),
      n_pes_(machine.n_pes()),
      runtime_(runtime),
      machine_(machine),
      pool_(pool),
      intercepts_(machine.intercepts_local()),
      patience_(machine.patience()),
      message_cost_(machine.message_cost()),
      completion_(*this),
      random_(mix(seed ^ mix(static_cast<std::uint64_t>(id.value)))),
      outbox_(id, machine, messages, statistics_.bytes_sent) {}

Pe::~Pe() = default;

void Pe::route(PeId to, Envelope* message) {
  message->target = to;
  if (to == id_ && !intercepts_) {
    ready_.push(message);
  } else if (machine_.same_process(id_, to)) {
    ++statistics_.sent_remote;
    machine_.post(id_, to, message, sizeof(Envelope), message->action->traffic);
  } else {
    ++statistics_.sent_remote;
    outbox_.put(message);
  }
}

void Pe::run(Envelope* message) {
  const bool counted = message->counted;
  if (stopped_ && counted) [[unlikely]] {
    discard(message);
    return;
  }
  const std::uint32_t charge = message->charge;
  const PeId sender = message->sender;
  message->charge = 0;  // wherever it goes from here
  context_ = Context{nullptr, message->action, message->epoch};
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
    exception("an exception that is no std::exception", 1);
  }
  context_ = Context{};
  if (charge != 0) [[unlikely]]
    repay(sender,
          charge);  // before it counts as processed: the run is not over while credit is due
  if (counted) completion_.hop_processed();
}

void Pe::run_traced(Envelope* message) {
  const Action* action = message->action;
  const PeId source = message->source;
  const std::uint32_t number = message->trace;
  const std::uint64_t begin = meter_->now();
  meter_->forget_entered();
  run(message);
  if (meter_->entered() != nullptr) action = meter_->entered();
  trace_->ran(action, begin, meter_->now(), source, number);
}

void Pe::note_place() {
  if (place_.empty()) place_ = runtime_.describe(*this);
}

void Pe::exception(const char* what, int exit_code) {
  note_place();
  const std::string place = std::exchange(place_, {});
  // Bad input is the user's to mend: one line, no trace. Everything else is a bug and says where it
  // was.
  if (exit_code == 2) {
    runtime_.error_line(text("error: ", one_line(what)));
  } else {
    runtime_.error_line(text("tessera: uncaught exception: ", what, "\n  ", place));
  }
  runtime_.exit(*this, exit_code);
}

std::size_t Pe::step(std::size_t most) {
  if (ready_.empty()) return 0;
  const RunsOn here(*this);
  std::size_t n = 0;
  if (meter_) [[unlikely]]
    meter_->step_begins();
  if (trace_) [[unlikely]] {
    for (; n < most && !ready_.empty(); ++n) {
      run_traced(static_cast<Envelope*>(ready_.pop()));
      outbox_.flush_if_due();
    }
  } else {
    for (; n < most && !ready_.empty(); ++n) {
      run(static_cast<Envelope*>(ready_.pop()));
      outbox_.flush_if_due();
    }
  }
  statistics_.messages += n;
  idle_calls_ = 0;
  messages_since_report_ += n;
  if (messages_since_report_ >= messages_between_reports) {
    messages_since_report_ = 0;
    completion_.report_epochs();
  }
  if (n <= few_messages) flush();
  if (message_cost_.count() != 0) machine_.charge(id_, message_cost_ * n);
  if (meter_) [[unlikely]]
    meter_->step_ends();
  return n;
}

bool Pe::idle() {
  const RunsOn here(*this);
  if (meter_) [[unlikely]]
    meter_->idle();
  messages_since_report_ = 0;
  bool busy = completion_.report_epochs();
  // Not at the first gap: a PE that is idle between two messages of a ping-pong would report each
  // time. Until then it claims to be busy, for the machine may let an idle PE sleep for good.
  if (completion_.run_changed()) {
    busy = ++idle_calls_ < patience_ || completion_.report_run() || busy;
  } else {
    pool_.flush();
  }
  return flush() || busy || !ready_.empty();
}

void Pe::drop_all() {
  while (!ready_.empty()) discard(static_cast<Envelope*>(ready_.pop()));
  for (auto& [id, messages] : early_) {
    for (Envelope* message : messages) discard(message);
  }
  early_.clear();
  outbox_.drop_all();
  dropping_ = true;
  end_all(suspended_);
}

Collection* Pe::find_slow(CollectionId id) {
  const auto at = collections_.find(id);
  if (at == collections_.end()) return nullptr;
  last_id_ = id;
  last_ = at->second.get();
  return last_;
}

void Pe::add(CollectionId id, std::unique_ptr<Collection> collection) {
  TESS_CHECK(!collections_.contains(id), id, " exists already on ", id_);
  collections_.emplace(id, std::move(collection));
  last_id_ = CollectionId{~std::uint64_t{0}};
  const auto early = early_.find(id);
  if (early == early_.end()) return;
  const std::vector<Envelope*> messages = std::move(early->second);
  early_.erase(early);
  for (Envelope* message : messages) send_here(message);
}

void Pe::keep_early(CollectionId id, Envelope* message) {
  early_[id].push_back(message);
}

CollectionId Pe::new_collection_id() {
  return CollectionId{(++n_collections_made_ << 24U) | static_cast<std::uint64_t>(id_.value)};
}

std::vector<Collection*> Pe::collections() const {
  std::vector<Collection*> all;
  for (const auto& [id, collection] : collections_) all.push_back(collection.get());
  return all;
}

void Pe::quiescent() {
  runtime_.quiescent(*this);
}

PeId Pe::whim() {
  if (migration_chance_ == 0 || !random_.chance(migration_chance_)) return id_;
  return PeId{static_cast<std::int32_t>(random_.below(static_cast<std::uint64_t>(n_pes_)))};
}

std::vector<std::string> Pe::census() const {
  std::vector<std::string> lines;
  for (const Suspended& one : suspended_) {
    lines.push_back(
        text(one.element != nullptr ? element_text(*one.element) : text("the main program"),
             " on ",
             id_,
             ": ",
             one.action != nullptr ? plain_name(one.action->name()) : std::string("run()"),
             " waits for ",
             one.waits_for()));
  }
  for (const auto& [id, collection] : collections_) collection->describe_waiting(lines);
  for (const auto& [id, messages] : early_)
    lines.push_back(
        text(messages.size(), " messages on ", id_, " wait for ", id, ", which was never created"));
  completion_.describe_open(lines);
  return lines;
}

}  // namespace tess
