// When is it all done? One mechanism answers for every scoped epoch and for the whole run (epoch
// 0).
//
// Each PE counts, for each epoch, the messages it sent and those it processed (cumulative, 64
// bits). A message that waits anywhere (in a queue, a send buffer, for an absent element, in a
// suspended coroutine) is sent and not yet processed. The epoch's coordinator, the PE that opened
// it, knows a reading of each PE that it was told of:
//
//   1. a PE that runs dry tells the coordinator its counters, if they changed since the last time;
//      those of the run go up the tree of all PEs, added up on the way, for all PEs tell of them;
//   2. when the sums of the tellings agree, sent = processed, the coordinator sends a wave over the
//      tree of all PEs, which adds up fresh readings;
//   3. if the wave's sum of *sent* equals the *processed* told before the wave began, nothing can
//      be under way: both counters only grow, so
//          processed(told) ≤ processed(now) ≤ sent(now) ≤ sent(wave)
//      are all equal (Mattern's four-counter argument; a telling is a reading of an earlier,
//      staggered wave).
//
// Epoch 0 counts every hop of every message but its own control messages; so while any epoch's
// control message is under way the run is not over. Its end is quiescence; what then still waits
// will wait for ever (census.hpp).
#pragma once

#include "runtime/ids.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace tess {

class Pe;

/// Messages sent and processed on one PE on account of one epoch.
struct Counters {
  std::uint64_t sent = 0;
  std::uint64_t processed = 0;
  friend bool operator==(const Counters&, const Counters&) = default;
  friend Counters operator+(const Counters& a, const Counters& b) {
    return {a.sent + b.sent, a.processed + b.processed};
  }
};

/// The last reading that each of some PEs told, and their sum.
class Tellings {
 public:
  /// False if it was overtaken by a later one: counters only grow, so the larger is the later.
  bool take(PeId from, const Counters& counters);
  [[nodiscard]] const Counters& sum() const { return sum_; }
  [[nodiscard]] const auto& by_pe() const { return by_pe_; }

 private:
  boost::unordered_flat_map<PeId, Counters, std::hash<PeId>> by_pe_;
  Counters sum_;
};

/// One PE's part in the completion of all epochs.
class Completion {
 public:
  explicit Completion(Pe& pe);

  /// Epoch 0: every hop of every message. Inline, on the path of each message.
  void hop_sent() { ++run_.sent; }
  void hop_processed() { ++run_.processed; }

  /// Another epoch: a message of a user, once at its sending and once when all it does is done.
  void sent(EpochId epoch) {
    if (epoch.value != 0) ++local(epoch).sent;
  }
  void processed(EpochId epoch) {
    if (epoch.value != 0) ++local(epoch).processed;
  }

  /// Opens an epoch that this PE coordinates; `on_done` runs on this PE once all is done. What is
  /// to belong to it is sent with this number; close() says that the body has run.
  EpochId open(EpochId parent, std::function<void()> on_done);
  void close(EpochId epoch);

  /// Tells the coordinators of scoped epochs what changed. True if anything was told.
  bool tell_epochs();
  /// True if the PE above in the tree has not been told all of the run.
  [[nodiscard]] bool run_changed() const { return run_ + run_below_.sum() != run_told_; }
  /// Tells it. True if anything was told.
  bool tell_run();

  /// One line for each epoch that this PE opened and that is not done.
  void describe_open(std::vector<std::string>& lines) const;

  // Control messages.
  struct Telling {
    EpochId epoch;
    PeId from;
    Counters counters;
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
  void on_telling(const Telling& telling);
  void on_wave(const Wave& wave);
  void on_echo(const Echo& echo);
  void on_end(const End& end);

 private:
  struct Local {
    Counters now;
    bool listed = false;
  };
  struct Coordinated {
    Tellings told;
    std::uint64_t wave = 0;
    std::uint64_t processed_before_wave = 0;
    bool wave_runs = false, again = false, closed = false;
    EpochId parent{};
    std::function<void()> on_done;
  };
  struct Relay {
    Wave wave;
    Counters sum;
    std::int32_t waiting = 0;
  };

  /// The counters of an epoch, to be changed now. The last one is at hand: runs of messages are of
  /// one epoch.
  [[nodiscard]] Counters& local(EpochId epoch) {
    if (epoch != last_epoch_) [[unlikely]]
      find_local(epoch);
    return *last_;
  }
  void find_local(EpochId epoch);
  void forget_last() { last_epoch_ = EpochId{}; }
  void tell(EpochId epoch, PeId whom, const Counters& counters);
  void check(EpochId epoch, Coordinated& of);
  void echo(Relay& relay);
  [[nodiscard]] Counters reading(EpochId epoch) const;

  Pe& pe_;
  Counters run_, run_told_;
  Tellings run_below_;  // of the PEs below this one in the tree; PE 0 coordinates, and has none
  boost::unordered_flat_map<EpochId, Local, std::hash<EpochId>> local_;
  std::vector<EpochId> changed_;
  EpochId last_epoch_{};  // 0: none. It is listed in changed_, and local_ has not changed since.
  Counters* last_ = nullptr;
  boost::unordered_flat_map<EpochId, Coordinated, std::hash<EpochId>> coordinated_;
  boost::unordered_flat_map<EpochId, Relay, std::hash<EpochId>> relays_;
  std::uint64_t n_opened_ = 0;
};

}  // namespace tess
