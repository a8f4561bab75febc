// A processing element: its queue, its collections, its part in completion, and its present
// context. The machine drives it (accept, step, idle); all code that runs on the PE communicates
// through it. Nothing here is shared: only the thread that runs the PE uses it.
#pragma once

#include "runtime/base/pool.hpp"
#include "runtime/core/check.hpp"
#include "runtime/pe/completion/counted.hpp"
#include "runtime/pe/completion_messages.hpp"
#include "runtime/pe/forced_migrations.hpp"
#include "runtime/pe/hosted_collections.hpp"
#include "runtime/pe/measuring.hpp"
#include "runtime/pe/nesting.hpp"
#include "runtime/pe/peers.hpp"
#include "runtime/pe/pending_error.hpp"
#include "runtime/pe/queues/ready_queue.hpp"
#include "runtime/pe/tables/future_table.hpp"
#include "runtime/pe/tables/suspended.hpp"
#include "runtime/pe/timers.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <atomic>
#include <cstdint>
#include <exception>
#include <limits>
#include <utility>

namespace tess::detail {

class TessElement;
using Element = TessElement;
class Runtime;
struct MessageOptions;

/// The context of running code: its element, its epoch, and the broadcast that led to it (0: none)
/// with the collection of that broadcast. The collection is that of the element if there is one.
struct Context {
  Element* element = nullptr;
  const Action* action = nullptr;
  EpochId epoch{};
  std::uint32_t led_by = 0;
  CollectionId led_in{};
};

/// Counters of a PE since the start; printed by --stats.
struct PeStatistics {
  std::uint64_t messages = 0;      ///< messages run on this PE
  std::uint64_t sent_remote = 0;   ///< messages sent to another PE
  std::uint64_t bytes_sent = 0;    ///< bytes packed for another process
  std::uint64_t forwards = 0;      ///< messages that met an element's former PE
  std::uint64_t migrations = 0;    ///< elements that left
  std::uint64_t dead_letters = 0;  ///< undeliverable messages to destroyed elements
  std::uint64_t late_replies = 0;  ///< replies that came after their asker had stopped waiting
};

class Pe {
 public:
  /// The pool outlives all PEs of the process, since one PE frees messages of another.
  Pe(PeId id, Runtime& runtime, Machine& machine, Pool& pool, std::uint64_t seed,
     const MessageOptions& messages);
  Pe(const Pe&) = delete;
  Pe& operator=(const Pe&) = delete;
  ~Pe();

  [[nodiscard]] PeId id() const { return id_; }
  [[nodiscard]] std::int32_t n_pes() const { return n_pes_; }
  [[nodiscard]] Machine& machine() { return machine_; }
  [[nodiscard]] Runtime& runtime() { return runtime_; }
  [[nodiscard]] Pool& pool() { return pool_; }
  [[nodiscard]] Time now() const { return machine_.now(id_); }

  // Its parts.

  [[nodiscard]] HostedCollections& collections() { return collections_; }
  [[nodiscard]] Completion& completion() { return completion_; }
  [[nodiscard]] PendingError& error() { return error_; }
  [[nodiscard]] Peers& peers() { return peers_; }
  [[nodiscard]] ForcedMigrations& forced_migrations() { return forced_migrations_; }
  /// The futures that are in use on this PE, by number. A result for another one is an error.
  [[nodiscard]] FutureTable& futures() { return futures_; }
  [[nodiscard]] Measuring& measuring() { return measuring_; }
  /// Measures this PE's code; null if nothing requests it.
  [[nodiscard]] Meter* meter() const { return measuring_.meter(); }
  [[nodiscard]] Nesting& nesting() { return nesting_; }
  [[nodiscard]] const ReadyQueue& ready() const { return ready_; }
  [[nodiscard]] PeStatistics& statistics() { return statistics_; }
  [[nodiscard]] SuspendedList& suspended() { return suspended_; }
  [[nodiscard]] Timers& timers() { return timers_; }

  // What runs.

  [[nodiscard]] Context& context() { return *context_; }
  /// Replaces the current context and returns the former one. The new one must live until it is
  /// replaced.
  Context* enter(Context* context) { return std::exchange(context_, context); }
  /// The action that runs now; null if none does. Any thread.
  [[nodiscard]] const Action* running() {
    // Partner: begins(). It points to a static object.
    return std::atomic_ref(of_message_.action).load(std::memory_order_relaxed);
  }
  /// The running message calls this action now.
  void begins(const Action* action) {
    std::atomic_ref(of_message_.action).store(action, std::memory_order_relaxed);
  }
  /// True if an entry method runs that may call another inside its send().
  [[nodiscard]] bool may_nest() const {
    return context_->element != nullptr && nesting_.has_room() && !stopped_;
  }
  /// True if the schedule may migrate an element after each message (forced migrations).
  [[nodiscard]] bool intercepts() const { return intercepts_; }
  /// No user code runs after this call. Messages that arrive are dropped, except those that epoch 0
  /// does not count.
  void stop_user_code() { stopped_ = true; }
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// True if the run is over and suspended coroutines are being freed.
  [[nodiscard]] bool dropping() const { return dropping_; }

  /// Marks a new message as sent by this PE in the current epoch.
  template <class M>
  M* stamp(M* message) {
    message->source = id_;
    message->epoch = context_->epoch;
    if (Trace* const trace = measuring_.trace()) [[unlikely]]
      message->trace = trace->sent(meter()->now());
    return message;
  }

  /// Counts a new message, which has been stamped, in its epoch. Where it ends, the Counted that
  /// holds it then counts it as processed. Not inline, since it stands in the code of each type of
  /// message; calls of entry methods are counted inline.
  void count(const Envelope& message);

  // Sending and forwarding of stamped messages. All functions take ownership.

  /// Sends to any PE, including this one.
  void send(PeId to, Envelope* message) {
    completion_.hop_sent();
    route(to, message);
  }
  /// Sends to this PE; the fast path of messages to local elements.
  void send_here(Envelope* message) {
    completion_.hop_sent();
    message->target = id_;
    if (intercepts_) [[unlikely]] {
      route(id_, message);
    } else {
      enqueue(message);
    }
  }
  /// Runs a message on this PE before all others but expedited ones that wait already, and before
  /// what an adversary does meanwhile.
  void run_next(Envelope* message) {
    completion_.hop_sent();
    message->target = id_;
    ready_.push(message, std::numeric_limits<std::int64_t>::min());
  }
  /// Sends to this PE, once the delay is over, a message that epoch 0 does not count.
  void post_after(Time delay, Envelope* message);
  /// Sends a message that epoch 0 does not count.
  void send_uncounted(PeId to, Envelope* message) {
    message->counted = false;
    route(to, message);
  }
  /// Puts such a message into the queue of this PE, past the machine, which may order all messages:
  /// a timer is exact.
  void put_uncounted(Envelope* message) {
    message->counted = false;
    message->target = id_;
    enqueue(message);
  }

  // The machine calls these through the runtime.

  void accept(Link* first);
  void accept(Bundle* bundle);
  std::size_t step(std::size_t most);
  bool idle();
  void busy();
  /// Passes a message that arrived from another process to its PE.
  void hand_over(Envelope* message, std::size_t n_bytes);
  void drop_all();

 private:
  /// Puts a message into the queue of this PE.
  void enqueue(Envelope* message) {
    if (message->prioritised) [[unlikely]] {
      ready_.push(message, message->action->priority_of(*message));
    } else {
      ready_.push(message);
    }
  }
  void route(PeId to, Envelope* message);
  void carry(PeId to, Envelope* message);
  void run_one(Envelope* message);
  void run(Envelope* message);
  void run_traced(Envelope* message);
  void exception(const char* what, int exit_code);

  const PeId id_;
  const std::int32_t n_pes_;
  Runtime& runtime_;
  Machine& machine_;
  Pool& pool_;
  const bool intercepts_;
  const unsigned patience_;
  const Time message_cost_;
  bool stopped_ = false;
  bool dropping_ = false;
  unsigned idle_calls_ = 0;
  std::size_t messages_since_report_ = 0;
  FutureTable futures_;  // outlives the elements, whose members they are
  PendingError error_{*this};
  Nesting nesting_;
  ReadyQueue ready_;
  Context of_message_;  // context of the running message
  Context* context_ = &of_message_;
  CompletionMessagesOfPe completion_messages_{*this};
  Completion completion_;
  SuspendedList suspended_;
  PeStatistics statistics_;
  Measuring measuring_{*this};
  ForcedMigrations forced_migrations_;
  Peers peers_;
  HostedCollections collections_{*this};
  Timers timers_{*this};
};

inline thread_local Pe* the_current_pe = nullptr;

/// The PE that this thread runs right now; null on a thread that runs none.
[[nodiscard]] inline Pe* current_pe_or_null() {
  return the_current_pe;
}

/// The PE that this thread runs right now. Misuse outside of a PE ends the job.
[[nodiscard]] Pe& current_pe();

/// Calls user code in the middle of the runtime's own work, such as a constructor, a map or the
/// operation of a reduction. An exception is kept, so that it ends the run, also if it is
/// caught.
template <class F>
decltype(auto) call_user(F&& code) {
  try {
    return std::forward<F>(code)();
  } catch (...) {
    current_pe().error().keep(std::current_exception());
    throw;
  }
}

/// Checks that the run has a PE of this number.
inline void check_exists(const Pe& pe, PeId id) {
  TESS_CHECK(id.value >= 0 && id.value < pe.n_pes(), "there is no ", id, ": the run has ",
             pe.n_pes(), pe.n_pes() == 1 ? " PE" : " PEs");
}

/// Makes a PE the current one during a scope.
class RunsOn {
 public:
  explicit RunsOn(Pe& pe) : before_(the_current_pe) { the_current_pe = &pe; }
  RunsOn(const RunsOn&) = delete;
  RunsOn& operator=(const RunsOn&) = delete;
  ~RunsOn() { the_current_pe = before_; }

 private:
  Pe* before_;
};

/// While a result is delivered: in the epoch of its contributions, and not led to by the broadcast
/// of the last contributor. (The action is left alone: other threads read it.)
class DeliveryScope {
 public:
  DeliveryScope(Pe& pe, EpochId epoch)
      : context_(pe.context()),
        epoch_(std::exchange(context_.epoch, epoch)),
        led_by_(std::exchange(context_.led_by, 0)) {}
  ~DeliveryScope() {
    context_.epoch = epoch_;
    context_.led_by = led_by_;
  }
  DeliveryScope(const DeliveryScope&) = delete;
  DeliveryScope& operator=(const DeliveryScope&) = delete;

 private:
  Context& context_;
  EpochId epoch_;
  std::uint32_t led_by_;
};

}  // namespace tess::detail

namespace tess {

// The names of this header that programs use. Other headers of the runtime end in the same way.
using detail::current_pe;
using detail::Pe;

}  // namespace tess
