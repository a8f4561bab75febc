// What a PE sends to other processes: a lane for each process, in which small messages are packed
// together until they leave: by size, after a few microseconds, when the PE idles, and before it
// starts local work on which others wait. A large message leaves by itself; its large vectors are
// not copied, they are sent from where they stand, and the message is kept until they have left.
//
//     put(message) ─► lane: | sender | header, bytes | header, bytes | … ─► Machine::send(Buffer)
//                  └► large: | sender | header, bytes |  + parts        ─► Machine::send(Parcel)
//
// The other end is Pe::receive and Pe::place. One PE's.
#pragma once

#include "runtime/base/ticks.hpp"
#include "runtime/ids.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/messages/envelope.hpp"

#include <cstddef>
#include <cstdint>
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
  std::uint32_t trace_and_counted = 0;  ///< the lowest bit: counted
};
static_assert(Bitwise<PackedFrom> && Bitwise<PackedHeader>);

/// How messages travel between processes.
struct MessageOptions {
  std::size_t attach_bytes = std::size_t{16} << 10;  ///< a vector of so many is a part of its own
};

class Outbox {
 public:
  Outbox(PeId self, Machine& machine, const MessageOptions& options);
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;
  ~Outbox() = default;

  /// Sends to a PE of another process; takes ownership. Returns the bytes of the message.
  std::uint64_t put(Envelope* message);
  /// Sends all that was held back to be packed together. True if there was any.
  bool flush();
  /// The same, once the oldest has waited for a few microseconds.
  void flush_if_due() {
    if (holds_packed_ && read_ticks() - packed_since_ > flush_ticks_) flush();
  }

 private:
  /// To one process.
  struct Lane {
    Buffer packed;
  };

  [[nodiscard]] std::uint64_t pack(Lane& lane, ProcessId process, Envelope* message);
  [[nodiscard]] std::size_t write(Lane& lane, Envelope* message);
  void make_room(Lane& lane, ProcessId process, std::size_t n_bytes);
  void send_packed(Lane& lane, ProcessId process);
  void send_parcel(Lane& lane, ProcessId process, Envelope* message, std::size_t n_bytes);
  void begin(Lane& lane) const;

  const PeId self_;
  Machine& machine_;
  const bool one_by_one_;
  const std::uint64_t flush_ticks_;
  bool holds_packed_ = false;
  std::uint64_t packed_since_ = 0;  // in ticks
  Attached attached_;
  std::vector<Lane> lanes_;
};

}  // namespace tess
