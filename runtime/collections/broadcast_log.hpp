// Broadcasts of one collection, seen from one PE. The root numbers them, and every PE applies them
// in that order to its elements. Each element carries the number of the last broadcast it received,
// so an element that migrates meanwhile receives each exactly once:
//
//     element arrives with seen < applied:  it catches up from the copies kept here
//     element arrives with seen > applied:  it is skipped until this PE has caught up
//
// A PE has settled broadcast n once it has applied n and every element that left before has arrived
// (and caught up) elsewhere. Only then does it report to the epoch and to the root. A copy is
// dropped once all PEs have settled it; no clock is involved.
#pragma once

#include "runtime/collections/broadcast_call.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

namespace tess::detail {

class Collection;
class Pe;

/// Starts a broadcast from this PE, even if the collection is not known here yet.
void start_broadcast(CollectionId collection, SharedCall call);

class BroadcastLog {
 public:
  BroadcastLog(Pe& pe, Collection& collection);

  /// The number of the last broadcast for an element that is created here now.
  [[nodiscard]] std::uint64_t applied() const { return applied_; }

  /// An element leaves and, later, has arrived elsewhere.
  void left(std::uint64_t seen) { ++in_flight_[seen]; }
  void arrived(std::uint64_t seen);

  /// The collection ends: its broadcasts here are dropped.
  void end();

  /// The calls that an element with this `seen` still has to receive here, oldest first.
  [[nodiscard]] std::vector<NumberedCall> missed(std::uint64_t seen) const;

  struct Settled {
    PeId from;
    std::uint64_t number;
  };
  struct Drop {
    std::uint64_t number;
  };
  void on_start(NumberedCall&& call);
  void on_call(NumberedCall&& call);
  void on_settled(const Settled& settled);
  void on_drop(const Drop& drop);

  [[nodiscard]] std::size_t n_kept() const { return copies_.size(); }

 private:
  void settle();

  Pe& pe_;
  Collection& collection_;
  std::vector<PeId> children_;
  std::uint64_t applied_ = 0;
  std::uint64_t settled_ = 0;
  std::uint64_t told_ = 0;
  std::uint64_t first_kept_ = 1;
  std::deque<NumberedCall> copies_;              // first_kept_ … applied_
  std::map<std::uint64_t, NumberedCall> early_;  // arrived before their turn
  std::map<std::uint64_t, std::uint64_t> in_flight_;

  // At the root.
  std::uint64_t last_number_ = 0;
  std::map<PeId, std::uint64_t> settled_by_;
  std::uint64_t dropped_ = 0;
};

}  // namespace tess::detail
