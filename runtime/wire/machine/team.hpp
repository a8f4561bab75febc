// The PEs of one process, one thread each: their inboxes, the loop that drives them, how they wait
// for work, and how they end together. The threads machine is a team; the mpi machine is a team and
// a network.
//
//     take_in → accept → step → network (when idle, or when due) → idle → rest
//
// Invariant: no inbox is read between the first PE's return from its loop and the last PE's, and no
// PE posts after the last one's. So each PE can take what remains and finish without the others.
#pragma once

#include "runtime/base/backoff.hpp"
#include "runtime/base/mpsc_queue.hpp"
#include "runtime/base/parker.hpp"
#include "runtime/wire/machine/machine.hpp"
#include "runtime/wire/machine/topology.hpp"

#include <atomic>
#include <vector>

namespace tess::detail {

/// Whether PEs are pinned to cores. `automatic` pins them if there is a core for each.
enum class Pinning { automatic, none };

/// What a PE polls in addition to its inbox.
class Network {
 public:
  Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  virtual ~Network() = default;

  /// Makes progress without waiting and passes received buffers to the program on this PE. Returns
  /// true if any arrived. Returns immediately if another PE makes progress.
  virtual bool progress(Program& program, PeId pe) = 0;
};

class Team {
 public:
  Team(PeId first, std::int32_t n_pes, Placement placement, Network* network);

  /// Any thread: hands a message to the PE and wakes it if it sleeps.
  void post(PeId to, Link* message) noexcept {
    Seat& seat = seats_[static_cast<std::size_t>(to.value - first_.value)];
    if (seat.inbox.push(message)) seat.parker.wake();
  }
  void post(PeId to, Bundle* bundle) noexcept {
    Seat& seat = seats_[static_cast<std::size_t>(to.value - first_.value)];
    if (seat.bundles.push(bundle)) seat.parker.wake();
  }

  /// Drives all PEs until stop(): the first on the calling thread, the others on threads of their
  /// own. Throws Error, before any PE runs, if the system does not start so many threads.
  void run(Program& program, const Topology& topology);

  /// Any thread, any number of times.
  void stop() noexcept;

 private:
  struct alignas(64) Seat {
    MpscQueue inbox;  // single messages; in one cache line with the bundles, since both are checked
    MpscQueue bundles;
    alignas(64) Parker parker;  // in a separate line: each producer reads it, few write it

    [[nodiscard]] bool empty() const noexcept { return inbox.empty() && bundles.empty(); }
  };

  void drive(Program& program, PeId pe, Seat& seat) noexcept;
  /// Passes all posted messages to the program. Returns false if there were none.
  static bool take_in(Program& program, PeId pe, Seat& seat) noexcept;
  void wait_for_all() noexcept;

  PeId first_;
  Placement placement_;
  Network* network_;
  Patience patience_;
  std::vector<Seat> seats_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::int32_t> n_running_{0};
};

}  // namespace tess::detail
