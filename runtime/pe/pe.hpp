// A processing element: its queue, its collections, its part in completion, and its present
// context. The machine drives it (accept, step, idle); all code that runs on the PE communicates
// through it. Nothing here is shared: only the thread that runs the PE uses it.
#pragma once

#include "runtime/base/pool.hpp"
#include "runtime/base/ticks.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/pe/completion/counted.hpp"
#include "runtime/pe/completion_messages.hpp"
#include "runtime/pe/interfaces/hosted_collection.hpp"
#include "runtime/pe/measure/trace.hpp"
#include "runtime/pe/meter.hpp"
#include "runtime/pe/queues/ready_queue.hpp"
#include "runtime/pe/tables/ended_collections.hpp"
#include "runtime/pe/tables/suspended.hpp"
#include "runtime/pe/timers.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <atomic>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tess::detail {

class TessElement;
using Element = TessElement;
class CollectionTable;
class ElementMover;
class FutureTable;
class IdleTime;
class Outbox;
class PeWatch;
class Runtime;
struct AfterMessage;
struct AuditRow;
struct MessageFault;
struct Waits;
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
  [[nodiscard]] Completion& completion() { return completion_; }
  [[nodiscard]] Context& context() { return *context_; }
  /// Replaces the current context and returns the former one. The new one must live until it is
  /// replaced.
  Context* enter(Context* context) { return std::exchange(context_, context); }
  [[nodiscard]] PeStatistics& statistics() { return statistics_; }
  /// How long this PE has been idle; null unless the run is monitored.
  [[nodiscard]] IdleTime* idle_time() { return idle_time_.get(); }
  void start_idle_time();
  /// The number of messages in the queue of this PE.
  [[nodiscard]] std::size_t n_ready() const { return ready_.size(); }
  [[nodiscard]] SuspendedList& suspended() { return suspended_; }
  [[nodiscard]] Random& random() { return random_; }
  [[nodiscard]] Timers& timers() { return timers_; }
  [[nodiscard]] Time now() const { return machine_.now(id_); }
  /// Measures this PE's code; null if nothing requests it.
  [[nodiscard]] Meter* meter() { return meter_.get(); }
  /// Starts measuring.
  Meter& start_meter();
  /// The same until stop_brief_meter(), unless start_meter() is called meanwhile.
  Meter& start_brief_meter();
  void stop_brief_meter();
  /// The record ends or leaves this PE: its meters write to it no more.
  void forget(const LoadRecord& record);

  /// What this PE runs, for a watching thread; null if nothing watches. With it the PE has a meter.
  [[nodiscard]] PeWatch* watch() { return watch_.get(); }
  void start_watch();
  /// Starts counting the messages to and from other PEs. A trace cannot be kept beside.
  void start_audit(const MessageFault& fault);
  /// What was counted; empty without an audit.
  [[nodiscard]] std::vector<AuditRow> audit_rows() const;

  /// Marks a new message as sent by this PE in the current epoch.
  template <class M>
  M* stamp(M* message) {
    message->source = id_;
    message->epoch = context_->epoch;
    if (trace_) [[unlikely]]
      message->trace = trace_->sent(meter_->now());
    return message;
  }

  /// Counts a new message, which has been stamped, in its epoch. Where it ends, the Counted that
  /// holds it then counts it as processed. Not inline, since it stands in the code of each type of
  /// message; calls of entry methods are counted inline.
  void count(const Envelope& message);

  /// Starts recording a trace.
  void start_trace(std::size_t most_records);
  /// Null without a trace.
  [[nodiscard]] Trace* trace() const { return trace_.get(); }

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

  // Collections.

  [[nodiscard]] HostedCollection* find(CollectionId id) {
    if (last_id_ == id) return last_;
    return find_slow(id);
  }
  /// Adds a collection; messages that arrived before it are sent on.
  void add(std::unique_ptr<HostedCollection> collection);
  /// Keeps a message whose collection is not known here yet. If the collection has ended here, the
  /// message is dropped: `drop` settles its epochs and returns the number of user messages that are
  /// lost with it.
  void keep_early(CollectionId id, Envelope* message, std::uint64_t (*drop)(Pe&, Envelope&));
  void keep_early_join(CollectionId id, std::uint32_t round);
  [[nodiscard]] std::vector<std::uint32_t> take_early_joins(CollectionId id);
  [[nodiscard]] bool ended(CollectionId id) const { return ended_.contains(id); }
  /// Removes a collection from the table: it ends here, and later messages to it are dropped.
  [[nodiscard]] std::unique_ptr<HostedCollection> take_out(CollectionId id);
  /// Keeps a removed collection until the coroutines of its elements are done.
  void keep_ending(std::unique_ptr<HostedCollection> collection, Counted end);
  /// If it is kept, what counts waits for it, too.
  void await_ending(CollectionId id, Counted&& end);
  struct Ending {
    std::vector<Counted> ends;  ///< the epochs of the ends wait for it
    std::unique_ptr<HostedCollection> collection;
  };
  [[nodiscard]] Ending take_ending(CollectionId id);
  [[nodiscard]] CollectionId new_collection_id(LateMessages late = LateMessages::counted);
  [[nodiscard]] std::vector<HostedCollection*> collections() const;
  /// For checkpoints: the ids that this PE has given, and, after a restart, ids of ended
  /// collections.
  [[nodiscard]] CollectionNumbers& collection_numbers() { return collection_numbers_; }
  void had_ended(CollectionId id) { ended_.add(id); }

  // The machine calls these through the runtime.

  void accept(Link* first);
  void accept(Bundle* bundle);
  std::size_t step(std::size_t most);
  bool idle();
  void busy();
  void receive(std::span<const std::byte> bytes);
  [[nodiscard]] Envelope* place(std::span<const std::byte> head,
                                std::span<const std::uint64_t> sizes,
                                std::vector<std::span<std::byte>>& taken);
  [[nodiscard]] Outbox& outbox() { return *outbox_; }
  /// A PE of another process has run messages that this PE sent to it.
  void on_repaid(PeId from, std::uint64_t amount);
  /// Passes a message that arrived from another process to its PE.
  void hand_over(Envelope* message, std::size_t n_bytes);
  /// Sends all messages that are held back to be packed together. Returns true if there were any.
  /// Called after a few microseconds, when the PE idles, and before it starts local work while
  /// other PEs wait.
  bool flush();
  void drop_all();

  /// No user code runs after this call. Messages that arrive are dropped, except those that epoch 0
  /// does not count.
  void stop_user_code() { stopped_ = true; }
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// True if the run is over and suspended coroutines are being freed.
  [[nodiscard]] bool dropping() const { return dropping_; }

  /// What waits on this PE for something from elsewhere. Coroutines with these frames are left out.
  [[nodiscard]] Waits census(std::span<void* const> except = {}) const;
  /// The same while the run goes on: also what is about to run.
  [[nodiscard]] Waits census_of_running() const;
  /// The action that runs now; null if none does. Any thread.
  [[nodiscard]] const Action* running() {
    // Partner: begins(). It points to a static object.
    return std::atomic_ref(of_message_.action).load(std::memory_order_relaxed);
  }
  /// The running message calls this action now.
  void begins(const Action* action) {
    std::atomic_ref(of_message_.action).store(action, std::memory_order_relaxed);
  }

  /// On a simulated machine that forces migrations: the PE that an element must move to now, or
  /// this PE.
  [[nodiscard]] PeId forced_migration(const AfterMessage& after);
  void set_forced_migrations(double chance, ElementMover* mover);

  /// The futures that are in use on this PE, by number. A result for another one is an error.
  std::uint64_t enter_future(void* future);
  void move_future(std::uint64_t id, void* future);
  void leave_future(std::uint64_t id);
  /// Null if the future is no longer in use.
  [[nodiscard]] void* find_future(std::uint64_t id) const;
  /// For restarts: numbers of futures made from now on begin behind those of the saved run, so that
  /// a callback that was saved finds none of them.
  [[nodiscard]] std::uint32_t places_of_futures() const;
  [[nodiscard]] bool has_futures() const;
  void begin_futures_behind(std::uint32_t places);
  /// Ends with an error that says why it was destroyed, or never was there.
  [[nodiscard]] void* require_future(std::uint64_t id) const;

  /// Keeps an exception that no user code may catch: of a coroutine after it has waited, or of a
  /// message that cannot be packed, whose epoch would wait for ever. It is rethrown at the end of
  /// the message that runs.
  void keep_exception(std::exception_ptr error);
  /// An exception leaves the code of an element: records the place for the report.
  void note_place();
  /// The same for code that is of no element: `instead` says what ran.
  void note_place(std::string_view instead);
  /// The exception was caught.
  void forget_place() { place_.clear(); }
  /// An exception leaves a constructor of a class: records it, with the types of its arguments, for
  /// the report.
  void note_constructor(std::string_view of, std::initializer_list<std::string_view> types);

  /// The index (and array) of the element under construction; null if there is none.
  [[nodiscard]] const void* constructed_index() const { return constructed_index_; }
  [[nodiscard]] HostedCollection* constructing_collection() const {
    return constructing_collection_;
  }
  /// Marks the run of a constructor. Marks nest if a constructor creates a collection.
  class Construction {
   public:
    Construction(Pe& pe, const void* index, HostedCollection* collection)
        : pe_(pe), index_(pe.constructed_index_), collection_(pe.constructing_collection_) {
      pe.constructed_index_ = index;
      pe.constructing_collection_ = collection;
    }
    Construction(const Construction&) = delete;
    Construction& operator=(const Construction&) = delete;
    ~Construction() {
      pe_.constructed_index_ = index_;
      pe_.constructing_collection_ = collection_;
    }

   private:
    Pe& pe_;
    const void* index_;
    HostedCollection* collection_;
  };

  /// True if an entry method runs that may call another inside its send().
  [[nodiscard]] bool may_nest() const {
    return context_->element != nullptr && n_nested_ < most_nested &&
           constructed_index_ == nullptr && !stopped_;
  }
  /// True inside a call of an entry method that another has made, or of code that must not call any.
  [[nodiscard]] bool nests() const { return n_nested_ != 0; }
  static constexpr unsigned most_nested = 16;
  /// Marks a call of an entry method inside another, or, with most_nested, code that must not call
  /// any.
  class Nested {
   public:
    explicit Nested(Pe& pe, unsigned n = 1) : pe_(pe), n_(n) { pe_.n_nested_ += n_; }
    Nested(const Nested&) = delete;
    Nested& operator=(const Nested&) = delete;
    ~Nested() { pe_.n_nested_ -= n_; }

   private:
    Pe& pe_;
    const unsigned n_;
  };

  /// True if the schedule may migrate an element after each message (forced migrations).
  [[nodiscard]] bool intercepts() const { return intercepts_; }

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
  /// Passes a message to another PE of this process.
  void pass(PeId to, Envelope* message, std::size_t n_bytes);
  void post(Bundle*& bundle, PeId to);
  void flush_bundles();
  /// Records that a message is held back, if none was.
  void hold();
  void look_at_clock(const Action& action);
  void run_slow(Envelope* message, const Action& action);
  void run_one(Envelope* message);
  void run(Envelope* message);
  void repay(PeId sender, std::uint32_t charge);
  void run_traced(Envelope* message);
  /// Counts a message that leaves for another PE. Returns false if a fault has taken the message.
  [[nodiscard]] bool audit_departure(PeId to, Envelope* message);
  void audit_arrival(Envelope* message);
  void audit_arrivals(Link* first);
  void carry(PeId to, Envelope* message);
  void exception(const char* what, int exit_code);
  HostedCollection* find_slow(CollectionId id);

  const PeId id_;
  const std::int32_t n_pes_;
  Runtime& runtime_;
  Machine& machine_;
  Pool& pool_;
  const bool intercepts_;
  const unsigned patience_;
  const Time message_cost_;
  const std::int32_t first_here_, n_here_;  // the range of this process's PEs
  const std::uint64_t bundle_ticks_, packed_ticks_;
  bool stopped_ = false;
  bool dropping_ = false;
  std::exception_ptr kept_exception_;
  const std::unique_ptr<FutureTable> futures_;  // outlives the elements, whose members they are
  std::string place_;                           // where the pending exception was thrown
  const void* constructed_index_ = nullptr;
  unsigned n_nested_ = 0;
  HostedCollection* constructing_collection_ = nullptr;
  ReadyQueue ready_;
  Context of_message_;  // context of the running message
  Context* context_ = &of_message_;
  CompletionMessagesOfPe completion_messages_;
  Completion completion_;
  SuspendedList suspended_;
  PeStatistics statistics_;
  Random random_;
  std::unique_ptr<Meter> meter_;
  std::unique_ptr<Meter> idle_meter_;  // one that measured briefly; scopes may still refer to it
  bool measures_briefly_ = false;
  std::unique_ptr<Trace> trace_;
  double migration_chance_ = 0;
  ElementMover* mover_ = nullptr;
  unsigned idle_calls_ = 0;
  std::unique_ptr<IdleTime> idle_time_;
  std::size_t messages_since_report_ = 0;

  const std::unique_ptr<Outbox> outbox_;  // messages to other processes

  // Messages that are held back to leave together: in the outbox, and pointers by PE of this
  // process.
  bool holds_ = false;
  std::uint32_t until_look_ = 1, look_every_ = 1;  // messages between two readings of the clock
  std::uint64_t held_since_ = 0, last_look_ = 0;   // ticks
  std::vector<Bundle*> bundles_;                   // empty if the machine takes no bundles
  std::vector<std::int32_t> opened_;               // the non-empty entries of bundles_
  CollectionId last_id_{~std::uint64_t{0}};
  HostedCollection* last_ = nullptr;
  CollectionNumbers collection_numbers_;
  const std::unique_ptr<CollectionTable> collection_table_;
  EndedCollections ended_;
  [[nodiscard]] std::vector<Ending>::iterator find_ending(CollectionId id);
  std::vector<Ending> ending_;
  Timers timers_{*this};
  struct Auditing;
  std::unique_ptr<Auditing> audit_;
  std::unique_ptr<PeWatch> watch_;
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
    current_pe().keep_exception(std::current_exception());
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
