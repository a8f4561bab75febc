// When is all work done? One mechanism answers for every scoped epoch and for the whole run (epoch
// 0).
//
// Each PE counts, for each epoch, the messages it sent and those it processed (cumulative, 64
// bits). A message that waits anywhere (in a queue, a send buffer, for an absent element, in a
// suspended coroutine) is sent and not yet processed. The epoch's coordinator is the PE that opened
// it.
//
//   1. An idle PE reports the counters of itself and of all PEs below it to its parent in the
//      coordinator's tree. It reports again only after the parent has answered, and the parent
//      answers when it is idle itself. So a busy PE is seldom disturbed, and an epoch costs a PE a
//      few messages per round trip, however small the tasks are.
//   2. When the coordinator's sums agree, sent = processed, it sends a wave over the tree of all
//      PEs, which adds up fresh readings.
//   3. If the wave's sum of *sent* equals the *processed* reported before the wave began, no message
//      can be under way: both counters only grow, so
//          processed(reported) ≤ processed(now) ≤ sent(now) ≤ sent(wave)
//      are all equal (Mattern's four-counter argument; a report is a reading of an earlier,
//      staggered wave).
//
//          coordinator      ▲ report (own + below)     │ wave      ▲ echo
//           /        \      │ ▼ answer                 ▼           │
//
// Epoch 0 counts every hop of every message except its own control messages: while any epoch's
// control message is under way the run is not over. Its end is quiescence. Whatever still waits
// then will wait for ever; Runtime reports it as a deadlock.
#pragma once

#include "runtime/base/spanning_tree.hpp"
#include "runtime/core/ids.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tess::detail {

/// The numbers of messages of one epoch that were sent and processed.
struct Counters {
  std::uint64_t sent = 0;
  std::uint64_t processed = 0;
  friend bool operator==(const Counters&, const Counters&) = default;
  friend Counters operator+(const Counters& a, const Counters& b) {
    return {a.sent + b.sent, a.processed + b.processed};
  }
};

/// One PE's part in one epoch: its own counters and the last report of each child in the tree.
struct Tally {
  Counters own;
  std::array<Counters, SpanningTree::fan_out> below{};  // by the child's slot
  Counters reported;        // sum() at the last report; at the coordinator, at the last check
  std::uint8_t heard = 0;   // one bit per child that has reported
  std::uint8_t owed = 0;    // one bit per child whose report has no answer yet
  bool unanswered = false;  // the report of this PE has no answer yet
  bool listed = false;      // in Completion::changed_

  [[nodiscard]] Counters sum() const {
    Counters all = own;
    for (const Counters& child : below) all = all + child;
    return all;
  }
};

/// The messages about epochs between PEs.
namespace completion {
struct Report {
  EpochId epoch;
  PeId from;
  Counters counters;
};
struct Answer {
  EpochId epoch;
};
struct Wave {
  EpochId epoch;
  PeId root;
  std::uint64_t number;
};
struct Echo {
  EpochId epoch;
  std::uint64_t number;
  Counters sum;
};
struct End {
  EpochId epoch;
};
}  // namespace completion

/// Sends the messages of a PE's Completion; the scheduler implements it. A message about epoch 0 is
/// not counted as a hop of epoch 0, since it would prolong what it measures.
class CompletionMessages {
 public:
  CompletionMessages() = default;
  CompletionMessages(const CompletionMessages&) = delete;
  CompletionMessages& operator=(const CompletionMessages&) = delete;
  virtual ~CompletionMessages() = default;

  virtual void send(PeId to, const completion::Report& report) = 0;
  virtual void send(PeId to, const completion::Answer& answer) = 0;
  virtual void send(PeId to, const completion::Wave& wave) = 0;
  virtual void send(PeId to, const completion::Echo& echo) = 0;
  virtual void send(PeId to, const completion::End& end) = 0;
  /// Epoch 0 is done. Called on PE 0.
  virtual void quiescent() = 0;
};

/// One PE's part in detecting the completion of all epochs.
class Completion {
 public:
  using Report = completion::Report;
  using Answer = completion::Answer;
  using Wave = completion::Wave;
  using Echo = completion::Echo;
  using End = completion::End;

  /// The part of PE `here` of `n_pes`.
  Completion(CompletionMessages& messages, PeId here, std::int32_t n_pes);
  Completion(const Completion&) = delete;
  Completion& operator=(const Completion&) = delete;
  ~Completion();

  /// Counts a hop of a message in epoch 0. Inline, since every message passes here.
  void hop_sent() { ++run_.own.sent; }
  void hop_processed() { ++run_.own.processed; }

  /// Opens an epoch that this PE coordinates; `on_done` runs on this PE once the epoch is done.
  /// Messages belong to it if they are sent with its number; close() marks the end of the body.
  EpochId open(EpochId parent, std::function<void()> on_done);
  void close(EpochId epoch);

  /// Reports changes of the scoped epochs and answers reports. Returns true if anything was sent or
  /// done.
  bool report_epochs();
  /// The run ends by an exception: it may have ended messages whose work is not done, so no epoch
  /// may end by them.
  void stop_reporting() { reports_ = false; }
  /// True if epoch 0 has something to report or to answer.
  [[nodiscard]] bool run_changed() const { return run_.owed != 0 || run_.sum() != run_.reported; }
  /// Reports and answers for epoch 0. Called when report_epochs() has nothing more to do: the
  /// report of a scoped epoch belongs to no message, so the counters of epoch 0 do not show that it
  /// is due. Returns true if anything was sent or done.
  bool report_run() { return report(EpochId{}, run_); }

  /// The messages of epoch 0 that this PE has sent.
  [[nodiscard]] std::uint64_t run_sent() const { return run_.own.sent; }
  /// The messages of epoch 0 that this PE has processed.
  [[nodiscard]] std::uint64_t run_processed() const { return run_.own.processed; }
  /// On PE 0: the messages of epoch 0 that all PEs had sent when it was found to be done.
  [[nodiscard]] std::uint64_t run_sent_by_all() const;

  /// The number of epochs that this PE keeps counters of.
  [[nodiscard]] std::size_t n_epochs() const;
  /// Appends one line for each unfinished epoch that this PE opened.
  void describe_open(std::vector<std::string>& lines) const;

  // A message about an epoch has arrived.
  void on(const Report& report);
  void on(const Answer& answer);
  void on(const Wave& wave);
  void on(const Echo& echo);
  void on(const End& end);

 private:
  friend class Counted;

  // Counts a user's message in an epoch other than 0: once when it is sent, and once when all its
  // work is done.
  void sent(EpochId epoch) {
    if (epoch.value != 0) ++own(epoch).sent;
  }
  void processed(EpochId epoch) {
    if (epoch.value != 0) ++own(epoch).processed;
  }
  void processed_by_call(EpochId epoch);  // not inline

  struct Relay;
  struct Epochs;

  /// The counters of an epoch, to be changed immediately. The last epoch's are cached, since
  /// consecutive messages often belong to one epoch.
  [[nodiscard]] Counters& own(EpochId epoch) {
    if (epoch != last_epoch_) [[unlikely]]
      find_own(epoch);
    return *last_;
  }
  void find_own(EpochId epoch);
  void forget_last() { last_epoch_ = EpochId{}; }
  [[nodiscard]] Tally* find(EpochId epoch);
  void list(EpochId epoch, Tally& tally);
  [[nodiscard]] SpanningTree tree_of(EpochId epoch) const;
  /// True on the coordinator if the epoch has ended.
  [[nodiscard]] bool is_over(EpochId epoch) const;
  /// Returns true if anything was sent or done. The tally may not exist afterwards.
  bool report(EpochId epoch, Tally& tally);
  void check(EpochId epoch, Counters sum);
  /// On the coordinator: requests a check for when this PE is idle, whether or not a counter
  /// changes until then.
  void check_later(EpochId epoch);
  void echo(Relay& relay);
  void end(EpochId epoch);
  [[nodiscard]] Counters reading(EpochId epoch) const;

  CompletionMessages& messages_;
  const PeId here_;
  const std::int32_t n_pes_;
  Tally run_;                             // of epoch 0
  const std::unique_ptr<Epochs> epochs_;  // the others; its tables are costly to compile
  std::vector<EpochId> changed_;          // something to report or to answer
  EpochId last_epoch_{};  // 0: none. It is listed, and its tally has not moved since.
  Counters* last_ = nullptr;
  std::uint64_t n_opened_ = 0;
  bool reports_ = true;
};

}  // namespace tess::detail
