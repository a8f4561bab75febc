// The messages between a PE and the others. Those that leave are held back for a short time, so that
// they leave together: pointers to messages in a bundle for each PE of this process, packed messages
// in the outbox for each other process. Those that arrive from another process are unpacked where
// they arrive, passed to their PE, and repaid once they have run.
//
//     pass, pack     a message is held back, or leaves at once
//     flush          what is held back leaves: after a few microseconds, when the PE idles, and
//                    before it starts local work while other PEs wait
#pragma once

#include "runtime/core/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tess::detail {

class Outbox;
class Pe;
struct Action;
struct Bundle;
struct Envelope;
struct MessageOptions;

class Peers {
 public:
  Peers(Pe& pe, const MessageOptions& messages);
  Peers(const Peers&) = delete;
  Peers& operator=(const Peers&) = delete;
  ~Peers();

  /// True for the PEs of this process.
  [[nodiscard]] bool in_process(PeId to) const {
    return static_cast<std::uint32_t>(to.value - first_here_) < static_cast<std::uint32_t>(n_here_);
  }
  /// Passes a message to another PE of this process.
  void pass(PeId to, Envelope* message, std::size_t n_bytes);
  /// Sends a message to another process.
  void pack(Envelope* message);

  /// True if messages are held back.
  [[nodiscard]] bool holds() const { return holds_; }
  /// Sends all of them. Returns true if there were any.
  bool flush();
  /// A message that may take long runs next: what is held back leaves before. Returns the time, for
  /// slow_ran().
  [[nodiscard]] std::uint64_t before_slow();
  void slow_ran(const Action& action, std::uint64_t began) const;
  /// A message of this action has run, while messages are held back.
  void ran(const Action& action) {
    if (--until_look_ == 0) look_at_clock(action);
  }
  void drop_all();

  [[nodiscard]] Outbox& outbox() { return *outbox_; }
  /// A message from another PE has run: repays its charge.
  void repay(PeId sender, std::uint32_t charge);
  /// A PE of another process has run messages that this PE sent to it.
  void on_repaid(PeId from, std::uint64_t amount);

  /// The machine passes these on: packed messages from another process, and one whose large vectors
  /// are still to arrive where `taken` says.
  void receive(std::span<const std::byte> bytes);
  [[nodiscard]] Envelope* place(std::span<const std::byte> head,
                                std::span<const std::uint64_t> sizes,
                                std::vector<std::span<std::byte>>& taken);

 private:
  void post(Bundle*& bundle, PeId to);
  void flush_bundles();
  /// Records that a message is held back, if none was.
  void hold();
  void look_at_clock(const Action& action);

  Pe& pe_;
  const std::int32_t first_here_, n_here_;  // the range of this process's PEs
  const std::uint64_t bundle_ticks_, packed_ticks_;
  bool holds_ = false;
  std::uint32_t until_look_ = 1, look_every_ = 1;  // messages between two readings of the clock
  std::uint64_t held_since_ = 0, last_look_ = 0;   // ticks
  std::vector<Bundle*> bundles_;                   // empty if the machine takes no bundles
  std::vector<std::int32_t> opened_;               // the non-empty entries of bundles_
  const std::unique_ptr<Outbox> outbox_;           // messages to other processes
};

}  // namespace tess::detail
