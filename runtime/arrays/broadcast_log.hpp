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

#include "runtime/arrays/broadcast_call.hpp"
#include "runtime/pe/completion/counted.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tess::detail {

/// A PE has settled all broadcasts up to this number.
struct BroadcastSettled {
  PeId from;
  std::uint64_t number;
};
/// All PEs have settled all broadcasts up to this number.
struct BroadcastDrop {
  std::uint64_t number;
};

/// What a BroadcastLog needs of its PE and its collection.
class BroadcastHost {
 public:
  BroadcastHost() = default;
  BroadcastHost(const BroadcastHost&) = delete;
  BroadcastHost& operator=(const BroadcastHost&) = delete;
  virtual ~BroadcastHost() = default;

  // The log of PE `to` receives these by on_call(), on_settled() and on_drop(). A call counts in its
  // epoch.
  virtual void send(PeId to, const NumberedCall& call) = 0;
  virtual void send(PeId to, const BroadcastSettled& settled) = 0;
  virtual void send(PeId to, const BroadcastDrop& drop) = 0;
  /// Sends all messages that are held back.
  virtual void flush() = 0;
  /// Calls all local elements that have not received this broadcast yet.
  virtual void apply(const NumberedCall& call) = 0;
};

class BroadcastLog {
 public:
  /// The part of PE `here` of `n_pes`; `root` numbers the broadcasts.
  BroadcastLog(BroadcastHost& host, PeId here, PeId root, std::int32_t n_pes);
  BroadcastLog(const BroadcastLog&) = delete;
  BroadcastLog& operator=(const BroadcastLog&) = delete;
  ~BroadcastLog();

  /// The number of the last broadcast for an element that is created here now.
  [[nodiscard]] std::uint64_t applied() const { return applied_; }

  /// An element leaves and, later, has arrived elsewhere.
  void left(std::uint64_t seen);
  void arrived(std::uint64_t seen);

  /// The collection ends: its broadcasts here are dropped.
  void end();

  /// The calls that an element with this `seen` still has to receive here, oldest first.
  [[nodiscard]] std::vector<NumberedCall> missed(std::uint64_t seen) const;

  /// At the root: a broadcast starts.
  void on_start(NumberedCall&& call, Counted counted);
  void on_call(NumberedCall&& call, Counted counted);
  void on_settled(const BroadcastSettled& settled);
  void on_drop(const BroadcastDrop& drop);

  [[nodiscard]] std::size_t n_kept() const;

 private:
  void settle();

  BroadcastHost& host_;
  const PeId here_, root_;
  const std::int32_t n_pes_;
  const std::vector<PeId> children_;
  std::uint64_t applied_ = 0;
  std::uint64_t settled_ = 0;
  std::uint64_t told_ = 0;
  std::uint64_t untold_bytes_ = 0;  // of the settled calls behind told_
  std::uint64_t first_kept_ = 1;
  struct Tables;
  const std::unique_ptr<Tables> tables_;  // the calls kept here

  // At the root.
  std::uint64_t last_number_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace tess::detail
