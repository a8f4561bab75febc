// Broadcasts of one collection, seen from one PE. The root numbers them; every PE applies them in
// that order to its elements; each element carries the number it has met, so that one that moves
// meanwhile meets each exactly once:
//
//     element arrives with seen < applied:  it catches up from the copies kept here
//     element arrives with seen > applied:  it is skipped until this PE has caught up
//
// A PE has settled n once it has applied n and each element that left before has landed (and caught
// up) elsewhere. Only then are the epoch's account and the root told; a copy is dropped once all
// PEs have settled it, never by a clock.
#pragma once

#include "runtime/collections/broadcast_call.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

namespace tess {

class Collection;
class Pe;

/// Starts a broadcast from this PE, on which the collection need not be known yet.
void start_broadcast(CollectionId collection, SharedCall call);

class BroadcastLog {
 public:
  BroadcastLog(Pe& pe, Collection& collection);

  /// The number that an element born here now has met.
  [[nodiscard]] std::uint64_t applied() const { return applied_; }

  /// Elements leave and, later, have landed.
  void left(std::uint64_t seen) { ++in_flight_[seen]; }
  void arrived(std::uint64_t seen);

  /// The collection ends: what is kept here is dropped.
  void end();

  /// The calls that an element that has met `seen` still has to meet here, oldest first.
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

}  // namespace tess
