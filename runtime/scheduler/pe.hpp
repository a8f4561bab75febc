// A processing element: its queue, its collections, its part in completion, and what it is doing
// right now. The machine drives it (accept, step, idle); everything that runs on the PE reaches the
// world through it. Nothing here is shared: a PE is touched by the one thread that runs it.
#pragma once

#include "runtime/base/pool.hpp"
#include "runtime/base/ticks.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/messages/envelope.hpp"
#include "runtime/scheduler/completion_messages.hpp"
#include "runtime/scheduler/ended_collections.hpp"
#include "runtime/scheduler/hosted_collection.hpp"
#include "runtime/scheduler/meter.hpp"
#include "runtime/scheduler/outbox.hpp"
#include "runtime/scheduler/ready_queue.hpp"
#include "runtime/scheduler/suspended.hpp"
#include "runtime/scheduler/trace.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tess {

class Element;
class Runtime;

/// What a PE is doing: whose code runs, on which epoch's account, and which broadcast of the
/// element's collection led to it (0: none).
struct Context {
  Element* element = nullptr;
  const Action* action = nullptr;
  EpochId epoch{};
  std::uint32_t led_by = 0;
};

/// What happened on a PE since the start; printed by --stats.
struct PeStatistics {
  std::uint64_t messages = 0;      ///< run on this PE
  std::uint64_t sent_remote = 0;   ///< to another PE
  std::uint64_t bytes_sent = 0;    ///< packed for another process
  std::uint64_t forwards = 0;      ///< messages that met an element's former PE
  std::uint64_t migrations = 0;    ///< elements that left
  std::uint64_t dead_letters = 0;  ///< messages to elements that are no more
  Time busy{0};
};

class Pe {
 public:
  /// The pool outlives all PEs of the process: messages of one are freed by another.
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
  /// Another context is in force from now on; returns the one before. It outlives its time in
  /// force.
  Context* enter(Context* context) { return std::exchange(context_, context); }
  [[nodiscard]] PeStatistics& statistics() { return statistics_; }
  [[nodiscard]] SuspendedList& suspended() { return suspended_; }
  [[nodiscard]] Random& random() { return random_; }
  [[nodiscard]] Time now() const { return machine_.now(id_); }
  /// What measures this PE's code; null while nobody asks for it.
  [[nodiscard]] Meter* meter() { return meter_.get(); }
  /// Measures from now on.
  Meter& start_meter() {
    if (!meter_) meter_ = std::make_unique<Meter>(machine_, id_);
    return *meter_;
  }

  /// Marks a new message as sent by this PE, on account of the epoch that runs.
  template <class M>
  M* stamp(M* message) {
    message->source = id_;
    message->epoch = context_->epoch;
    if (trace_) [[unlikely]]
      message->trace = trace_->sent(meter_->now());
    return message;
  }

  /// Keeps a trace from now on.
  void start_trace(std::size_t most_records) {
    start_meter();
    trace_ = std::make_unique<Trace>(most_records);
  }
  [[nodiscard]] const Trace* trace() const { return trace_.get(); }

  // Sending and forwarding of stamped messages. All take ownership.

  /// To any PE, also this one.
  void send(PeId to, Envelope* message) {
    completion_.hop_sent();
    route(to, message);
  }
  /// To this PE; the fast path of messages to local elements.
  void send_here(Envelope* message) {
    completion_.hop_sent();
    message->target = id_;
    if (intercepts_) [[unlikely]] {
      route(id_, message);
    } else {
      ready_.push(message);
    }
  }
  /// Outside of epoch 0.
  void send_uncounted(PeId to, Envelope* message) {
    message->counted = false;
    route(to, message);
  }

  // Collections.

  [[nodiscard]] HostedCollection* find(CollectionId id) {
    if (last_id_ == id) return last_;
    return find_slow(id);
  }
  /// Enters a collection; messages that came before it are sent on.
  void add(std::unique_ptr<HostedCollection> collection);
  /// Keeps a message whose collection is not known here yet. One whose collection has ended here is
  /// dropped: `drop` settles its accounts and returns how many user messages are lost with it.
  void keep_early(CollectionId id, Envelope* message, std::uint64_t (*drop)(Pe&, Envelope&));
  [[nodiscard]] bool ended(CollectionId id) const { return ended_.contains(id); }
  /// Takes a collection out of the table: it ends here, and messages to it are dropped from now on.
  [[nodiscard]] std::unique_ptr<HostedCollection> take_out(CollectionId id);
  /// Keeps a collection that was taken out until the coroutines of its elements are done.
  void keep_ending(std::unique_ptr<HostedCollection> collection, EpochId epoch);
  struct Ending {
    std::unique_ptr<HostedCollection> collection;
    EpochId epoch{};  ///< waits for it
  };
  [[nodiscard]] Ending take_ending(CollectionId id);
  [[nodiscard]] CollectionId new_collection_id(LateMessages late = LateMessages::counted) {
    return collection_numbers_.next(id_, late);
  }
  [[nodiscard]] std::vector<HostedCollection*> collections() const;

  // Called by the machine through the runtime.

  void accept(Link* first) {
    for (Link* next = nullptr; first != nullptr; first = next) {
      next = first->next;
      ready_.push(first);
    }
  }
  void accept(Bundle* bundle);
  std::size_t step(std::size_t most);
  bool idle();
  void receive(std::span<const std::byte> bytes);
  [[nodiscard]] Envelope* place(std::span<const std::byte> head,
                                std::span<const std::uint64_t> sizes,
                                std::vector<std::span<std::byte>>& taken);
  [[nodiscard]] Outbox& outbox() { return outbox_; }
  /// A PE of another process has run what this PE had sent there.
  void on_repaid(PeId from, std::uint64_t amount);
  /// Hands a message that came from another process to its PE.
  void hand_over(Envelope* message, std::size_t n_bytes);
  /// Sends all that was held back to be packed together. True if there was any. Called after a few
  /// microseconds, when the PE idles, and before it starts local work on which other PEs wait.
  bool flush();
  void drop_all();

  /// No user code runs from here on; what comes in is dropped, but for messages outside of epoch 0.
  void stop_user_code() { stopped_ = true; }
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// The run is over, and what waited is freed.
  [[nodiscard]] bool dropping() const { return dropping_; }

  /// What waits on this PE for something that must come from elsewhere, a line each.
  [[nodiscard]] std::vector<std::string> census() const;

  /// With a simulated machine that forces migrations: the PE an element has to go to now, or this
  /// one.
  [[nodiscard]] PeId forced_migration();
  void set_migration_chance(double chance) { migration_chance_ = chance; }

  /// Futures that were made on this PE, by number; a result for one that is gone is an error.
  std::uint64_t enter_future(void* future) {
    futures_.emplace(++n_futures_, future);
    return n_futures_;
  }
  void leave_future(std::uint64_t id) { futures_.erase(id); }
  [[nodiscard]] void* find_future(std::uint64_t id) const {
    const auto at = futures_.find(id);
    return at == futures_.end() ? nullptr : at->second;
  }

  /// An exception that a coroutine threw after it had waited; thrown again once its message is at
  /// its end.
  void keep_exception(std::exception_ptr error) {
    note_place();
    if (!kept_exception_) kept_exception_ = std::move(error);
  }
  /// An exception leaves the code of an element: the report is to say where that was.
  void note_place();
  /// The same for a constructor, by its name.
  void note_constructor(const std::string& name);

  /// The index (and array) of the element that is constructed right now; null between.
  [[nodiscard]] const void* constructed_index() const { return constructed_index_; }
  [[nodiscard]] HostedCollection* constructing_collection() const {
    return constructing_collection_;
  }
  /// Marks a constructor's run; they nest where a constructor creates a collection.
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

  /// Calls that the schedule makes wait until the end of the current message (element surgery).
  [[nodiscard]] bool intercepts() const { return intercepts_; }

 private:
  void route(PeId to, Envelope* message);
  /// To a PE of this process, not this one.
  void pass(PeId to, Envelope* message, std::size_t n_bytes);
  void post(Bundle*& bundle, PeId to);
  void flush_bundles();
  /// Something is held back from now on, if nothing was.
  void hold() {
    if (holds_) return;
    holds_ = true;
    held_since_ = last_look_ = read_ticks();
    until_look_ = look_every_ = 1;
  }
  void look_at_clock(const Action& action);
  void run_slow(Envelope* message, const Action& action);
  void run_one(Envelope* message);
  void run(Envelope* message);
  void repay(PeId sender, std::uint32_t charge);
  void run_traced(Envelope* message);
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
  const std::int32_t first_here_, n_here_;  // the PEs of this process
  const std::uint64_t bundle_ticks_, packed_ticks_;
  bool stopped_ = false;
  bool dropping_ = false;
  std::exception_ptr kept_exception_;
  std::uint64_t n_futures_ = 0;
  boost::unordered_flat_map<std::uint64_t, void*> futures_;
  std::string place_;  // where the exception on its way was thrown
  const void* constructed_index_ = nullptr;
  HostedCollection* constructing_collection_ = nullptr;
  ReadyQueue ready_;
  Context of_message_;  // of the message that runs
  Context* context_ = &of_message_;
  CompletionMessagesOfPe completion_messages_;
  Completion completion_;
  SuspendedList suspended_;
  PeStatistics statistics_;
  Random random_;
  std::unique_ptr<Meter> meter_;
  std::unique_ptr<Trace> trace_;
  double migration_chance_ = 0;
  unsigned idle_calls_ = 0;
  std::size_t messages_since_report_ = 0;

  Outbox outbox_;  // to other processes

  // What is held back to leave together: in the outbox, and pointers by PE of this process.
  bool holds_ = false;
  std::uint32_t until_look_ = 1, look_every_ = 1;  // messages between two looks at the clock
  std::uint64_t held_since_ = 0, last_look_ = 0;   // in ticks
  std::vector<Bundle*> bundles_;                   // empty where the machine takes none
  std::vector<std::int32_t> opened_;               // those of bundles_ that hold something
  CollectionId last_id_{~std::uint64_t{0}};
  HostedCollection* last_ = nullptr;
  CollectionNumbers collection_numbers_;
  boost::unordered_flat_map<CollectionId, std::unique_ptr<HostedCollection>,
                            std::hash<CollectionId>>
      collections_;
  boost::unordered_flat_map<CollectionId, std::vector<Envelope*>, std::hash<CollectionId>> early_;
  EndedCollections ended_;
  std::vector<Ending> ending_;
};

namespace detail {
inline thread_local Pe* the_current_pe = nullptr;
}

/// The PE that this thread runs right now; null on a thread that runs none.
[[nodiscard]] inline Pe* current_pe_or_null() {
  return detail::the_current_pe;
}

/// The PE that this thread runs right now. Misuse outside of a PE ends the job.
[[nodiscard]] Pe& current_pe();

/// There must be a PE of that number in the run.
inline void check_exists(const Pe& pe, PeId id) {
  TESS_CHECK(id.value >= 0 && id.value < pe.n_pes(), "there is no ", id, ": the run has ",
             pe.n_pes(), pe.n_pes() == 1 ? " PE" : " PEs");
}

/// Makes a PE current for a scope.
class RunsOn {
 public:
  explicit RunsOn(Pe& pe) : before_(detail::the_current_pe) { detail::the_current_pe = &pe; }
  RunsOn(const RunsOn&) = delete;
  RunsOn& operator=(const RunsOn&) = delete;
  ~RunsOn() { detail::the_current_pe = before_; }

 private:
  Pe* before_;
};

}  // namespace tess
