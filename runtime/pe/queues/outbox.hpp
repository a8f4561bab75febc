// The messages that a PE sends to other processes. There is a lane for each process, in which small
// messages are packed together until they are sent: when the buffer is full, after a few
// microseconds, when the PE idles, and before it starts local work while others wait for its
// messages. A large message is sent alone; its large vectors are not copied but sent from their own
// memory, and the message is kept until they have been sent.
//
//     put(message) ─► lane: | sender | header, bytes | header, bytes | … ─► Machine::send(Buffer)
//                  └► large: | sender | header, bytes |  + parts        ─► Machine::send(Parcel)
//
// Credit bounds the memory. A user's message is charged to its lane, by its bytes, until the
// receiver has run it. A lane packs messages while the bytes under way are below half of its
// budget; with the next message they are within the budget, or are half of it and that message.
// Later messages wait here, unpacked. The receiver repays in portions, by messages that need no
// credit:
//
//     portion = limit / (2 × PEs of the receiving process):  its PEs together keep back less than
//     half of the limit, so some of the bytes under way are always about to be repaid
//
// Messages that wait here leave in the order of their priorities. A message that has run is repaid
// wherever it goes then, and messages of the runtime itself are not charged. So nothing that holds
// credit waits for credit, and no deadlock is possible. A message that waits here counts as sent
// and not processed, so its epochs wait for it.
//
// The other end is Peers::receive and Peers::place. An outbox belongs to one PE.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/pe/queues/ready_queue.hpp"
#include "runtime/wire/machine/machine.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <utility>
#include <vector>

namespace tess::detail {

/// The beginning of a buffer of packed messages and of the head of a parcel.
struct PackedFrom {
  PeId sender;
  std::uint32_t unused = 0;
};

/// The header of each packed message.
struct PackedHeader {
  std::uint64_t n_bytes = 0;  ///< bytes behind this header, without attached parts
  EpochId epoch{};
  std::uint32_t action = 0;
  PeId source{};
  PeId target{};
  std::uint32_t trace_and_flags = 0;  ///< the lowest bits: counted, charged, prioritised

  static constexpr std::uint32_t counted = 1;
  static constexpr std::uint32_t charged = 2;
  static constexpr std::uint32_t prioritised = 4;
  static constexpr unsigned n_flags = 3;
};
static_assert(Bitwise<PackedFrom> && Bitwise<PackedHeader>);
static_assert(Envelope::most_trace << PackedHeader::n_flags >> PackedHeader::n_flags ==
              Envelope::most_trace);

/// The credit that so many bytes take.
[[nodiscard]] constexpr std::uint64_t credits(std::uint64_t n_bytes) {
  return n_bytes / 16 + 1;
}
/// The same for a message; of one above 64 GiB it is that of 64 GiB.
[[nodiscard]] constexpr std::uint32_t credit_of(std::uint64_t n_bytes) {
  constexpr std::uint32_t most = ~std::uint32_t{0};
  return credits(n_bytes) < most ? static_cast<std::uint32_t>(credits(n_bytes)) : most;
}

class Outbox {
 public:
  /// Counts the packed bytes in `bytes_sent`.
  Outbox(PeId self, Machine& machine, const MessageOptions& options, std::uint64_t& bytes_sent);
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;
  ~Outbox() = default;

  /// Sends to a PE of another process; takes ownership.
  void put(Envelope* message);
  /// Sends all messages that are held back to be packed together. Returns true if there were any.
  bool flush();
  /// True if messages are held back; the PE calls flush() in time.
  [[nodiscard]] bool holds() const { return holds_packed_; }

  /// A message of this sender has run here. Returns the credit to be repaid now, mostly 0.
  [[nodiscard]] std::uint64_t owe(PeId sender, std::uint32_t credit);
  /// A PE of this process has repaid credit: messages that waited are sent as far as it allows.
  void repaid(ProcessId process, std::uint64_t credit);

  /// True if a message to this process would not wait.
  [[nodiscard]] bool has_room(ProcessId process) const { return lane(process).under_way < limit_; }
  /// Calls `go_on` once there is room. Several producers continue one after the other (go_on_one).
  void wait_for_room(ProcessId process, std::function<void()> go_on) {
    lane(process).producers.push_back(std::move(go_on));
  }
  /// Lets the first waiting producer continue, if there is one. Returns true if others wait.
  bool go_on_one(ProcessId process);
  [[nodiscard]] bool awaited(ProcessId process) const { return !lane(process).producers.empty(); }

  /// The number of messages that wait for credit.
  [[nodiscard]] std::size_t n_waiting(ProcessId process) const { return lane(process).n_waiting(); }

  /// Frees the messages that wait.
  void drop_all();

 private:
  /// The messages to one process. There are as many lanes as processes, most of them idle.
  struct Lane {
    Buffer packed;
    std::uint64_t under_way = 0;  // credit
    /// Waiting for credit: none while under_way < limit_. Made for the first.
    std::unique_ptr<ReadyQueue> waiting;
    std::list<std::function<void()>> producers;  // waiting for room

    [[nodiscard]] std::size_t n_waiting() const { return waiting ? waiting->size() : 0; }
    [[nodiscard]] Envelope* pop() { return static_cast<Envelope*>(waiting->pop()); }
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
  const std::uint64_t limit_;    // credit of a lane
  const std::uint64_t portion_;  // credit that is repaid at once
  std::uint64_t& bytes_sent_;
  bool holds_packed_ = false;
  Attached attached_;
  std::vector<Lane> lanes_;
  std::vector<std::uint64_t> owed_;  // credit owed to each PE; empty until there is any
};

}  // namespace tess::detail
