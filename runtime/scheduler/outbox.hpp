// What a PE sends to other processes: a lane for each process, in which small messages are packed
// together until they leave: by size, after a few microseconds, when the PE idles, and before it
// starts local work on which others wait. A large message leaves by itself; its large vectors are
// not copied, they are sent from where they stand, and the message is kept until they have left.
//
//     put(message) ─► lane: | sender | header, bytes | header, bytes | … ─► Machine::send(Buffer)
//                  └► large: | sender | header, bytes |  + parts        ─► Machine::send(Parcel)
//
// Memory is bounded by credit. What users send is charged to its lane, by its bytes, until the
// receiver has run it: a lane packs while what is under way is below half of its budget, so that
// with the next message it is within the budget, or half of it and that message. What comes later
// waits here, unpacked. The receiver repays in portions, by messages that need no credit:
//
//     portion = limit / (2 × PEs of the receiving process):  its PEs together keep back less than
//     half of the limit, so some of what is under way is always about to be repaid
//
// A message that has run is repaid wherever it goes then, and messages of the runtime itself are
// not charged. So nothing that holds credit waits for credit, and no deadlock is possible. What
// waits here is sent and not processed: its epochs wait with it.
//
// The other end is Pe::receive and Pe::place. One PE's.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/messages/envelope.hpp"
#include "runtime/scheduler/ready_queue.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <utility>
#include <vector>

namespace tess {

/// What a buffer of packed messages, and the head of a parcel, begin with.
struct PackedFrom {
  PeId sender;
  std::uint32_t unused = 0;
};

/// What stands before each packed message.
struct PackedHeader {
  std::uint64_t n_bytes = 0;  ///< behind this header; without attached parts
  EpochId epoch{};
  std::uint32_t action = 0;
  PeId source{};
  PeId target{};
  std::uint32_t trace_and_flags = 0;  ///< the lowest bits: counted, charged

  static constexpr std::uint32_t counted = 1;
  static constexpr std::uint32_t charged = 2;
  static constexpr unsigned n_flags = 2;
};
static_assert(Bitwise<PackedFrom> && Bitwise<PackedHeader>);

/// The credit that a message of so many bytes takes.
[[nodiscard]] constexpr std::uint32_t credit_of(std::uint64_t n_bytes) {
  return static_cast<std::uint32_t>(n_bytes / 16 + 1);
}

/// How messages travel between processes.
struct MessageOptions {
  std::size_t attach_bytes = std::size_t{16} << 10;  ///< a vector of so many is a part of its own
  std::size_t memory_bytes = std::size_t{32} << 20;  ///< under way from one process to another
};

class Outbox {
 public:
  /// Counts in `bytes_sent` what it packs.
  Outbox(PeId self, Machine& machine, const MessageOptions& options, std::uint64_t& bytes_sent);
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;
  ~Outbox() = default;

  /// Sends to a PE of another process; takes ownership.
  void put(Envelope* message);
  /// Sends all that was held back to be packed together. True if there was any.
  bool flush();
  /// Something is held back; the PE calls flush() in time.
  [[nodiscard]] bool holds() const { return holds_packed_; }

  /// A message of that sender has run here: what is to be repaid now, mostly 0.
  [[nodiscard]] std::uint64_t owe(PeId sender, std::uint32_t credit);
  /// A PE of that process has repaid: what waited is sent as far as it may.
  void repaid(ProcessId process, std::uint64_t credit);

  /// A message to that process would not wait.
  [[nodiscard]] bool has_room(ProcessId process) const { return lane(process).under_way < limit_; }
  /// Calls `go_on` once there is room, of several one after the other (go_on_one).
  void wait_for_room(ProcessId process, std::function<void()> go_on) {
    lane(process).producers.push_back(std::move(go_on));
  }
  /// Lets the first that waits for room go on, if there is any. True if others wait.
  bool go_on_one(ProcessId process);
  [[nodiscard]] bool awaited(ProcessId process) const { return !lane(process).producers.empty(); }

  /// Frees what waits.
  void drop_all();

 private:
  /// To one process.
  struct Lane {
    Buffer packed;
    std::uint64_t under_way = 0;                  // credit
    ReadyQueue waiting;                           // for credit; empty while under_way < limit_
    std::deque<std::function<void()>> producers;  // wait for room
  };

  [[nodiscard]] Lane& lane(ProcessId process) {
    return lanes_[static_cast<std::size_t>(process.value)];
  }
  [[nodiscard]] const Lane& lane(ProcessId process) const {
    return lanes_[static_cast<std::size_t>(process.value)];
  }
  void pack(Lane& lane, ProcessId process, Envelope* message, bool charged);
  [[nodiscard]] std::size_t write(Lane& lane, Envelope* message, bool charged);
  void make_room(Lane& lane, ProcessId process, std::size_t n_bytes);
  void send_packed(Lane& lane, ProcessId process);
  void send_parcel(Lane& lane, ProcessId process, Envelope* message, std::size_t n_bytes);
  void begin(Lane& lane) const;

  const PeId self_;
  Machine& machine_;
  const bool one_by_one_;
  const std::uint64_t limit_;    // of a lane, in credit
  const std::uint64_t portion_;  // that is repaid
  std::uint64_t& bytes_sent_;
  bool holds_packed_ = false;
  Attached attached_;
  std::vector<Lane> lanes_;
  std::vector<std::uint64_t> owed_;  // to each PE, once there is anything
};

}  // namespace tess
