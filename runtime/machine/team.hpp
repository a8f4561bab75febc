// The PEs of one process, each a thread: their inboxes, the loop that drives them, how they rest,
// and how they end together. The threads machine is a team; the mpi machine is a team and a
// network.
//
//     take_in → accept → step → network (when idle, or when due) → idle → rest
//
// Invariant: between the first PE's return from its loop and the last one's no inbox is read, and
// after the last one's no PE posts; so each PE can take what remains and finish alone.
#pragma once

#include "runtime/base/backoff.hpp"
#include "runtime/base/mpsc_queue.hpp"
#include "runtime/base/parker.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine/topology.hpp"

#include <atomic>
#include <vector>

namespace tess {

/// Whether PEs are tied to cores. `automatic` ties them if there is a core for each.
enum class Pinning { automatic, none };

/// What a PE polls besides its inbox.
class Network {
 public:
  Network() = default;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  virtual ~Network() = default;

  /// Moves what can be moved without waiting; hands received buffers to the program on this PE.
  /// True if any came. Returns at once if another PE is at it.
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

  /// Drives all PEs until stop(): the first on this thread, each other one on a thread of its own.
  void run(Program& program, const Topology& topology);

  /// Any thread, any number of times.
  void stop() noexcept;

 private:
  struct alignas(64) Seat {
    MpscQueue inbox;  // single messages; in one line with the bundles, for both are looked at
    MpscQueue bundles;
    alignas(64) Parker parker;  // apart from the queues: each producer reads it, few write it

    [[nodiscard]] bool empty() const noexcept { return inbox.empty() && bundles.empty(); }
  };

  void drive(Program& program, PeId pe, Seat& seat) noexcept;
  /// Hands all that was posted to the program. False if there was nothing.
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

}  // namespace tess
