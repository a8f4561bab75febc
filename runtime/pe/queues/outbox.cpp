#include "runtime/pe/queues/outbox.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace tess::detail {
namespace {

/// A lane's buffer is sent when it holds so many bytes.
constexpr std::size_t flush_bytes = 32U << 10U;
/// The buffer's initial and its largest size: with one more message it is still sent without
/// announcement.
constexpr std::size_t first_bytes = 4U << 10U;
constexpr std::size_t most_bytes = 36U << 10U;

/// Releases a message whose parts have been sent, on the thread that notices it.
struct Sent {
  Envelope* message;
  std::vector<std::shared_ptr<const void>> keepers;

  Sent(Envelope* message_, std::vector<std::shared_ptr<const void>>&& keepers_)
      : message(message_), keepers(std::move(keepers_)) {}
  Sent(const Sent&) = delete;
  Sent& operator=(const Sent&) = delete;
  ~Sent() { discard(message); }
};

}  // namespace

Outbox::Outbox(PeId self, Machine& machine, const MessageOptions& options,
               std::uint64_t& bytes_sent)
    : self_(self),
      machine_(machine),
      one_by_one_(machine.intercepts_local()),
      limit_(
          credits(options.memory_bytes / 2 / static_cast<std::size_t>(machine.pes_per_process()))),
      portion_(std::max<std::uint64_t>(
          limit_ / 2 / static_cast<std::size_t>(machine.pes_per_process()), 1)),
      bytes_sent_(bytes_sent),
      lanes_(static_cast<std::size_t>(machine.n_processes())) {
  attached_.least_bytes = options.attach_bytes;
}

void Outbox::put(Envelope* message) {
  const ProcessId process = machine_.process_of(message->target);
  Lane& to = lane(process);
  const bool charged = message->action->traffic == Traffic::user && message->counted;
  if (charged && to.under_way >= limit_) [[unlikely]] {
    if (!to.waiting) to.waiting = std::make_unique<ReadyQueue>();
    to.waiting->push(message, message->prioritised ? message->action->priority_of(*message) : 0);
  } else {
    pack(to, process, message, charged);
  }
}

std::uint64_t Outbox::owe(PeId sender, std::uint32_t credit) {
  if (owed_.empty()) owed_.resize(static_cast<std::size_t>(machine_.n_pes()));
  std::uint64_t& owed = owed_[static_cast<std::size_t>(sender.value)];
  owed += credit;
  return owed >= portion_ ? std::exchange(owed, 0) : 0;
}

void Outbox::repaid(ProcessId process, std::uint64_t credit) {
  Lane& to = lane(process);
  to.under_way -= credit;
  while (to.under_way < limit_ && to.n_waiting() > 0) pack(to, process, to.pop(), true);
}

bool Outbox::go_on_one(ProcessId process) {
  Lane& to = lane(process);
  if (to.producers.empty() || to.under_way >= limit_) return false;
  const std::function<void()> go_on = std::move(to.producers.front());
  to.producers.pop_front();
  go_on();
  return !to.producers.empty();
}

void Outbox::drop_all() {
  for (Lane& to : lanes_) {
    while (to.n_waiting() > 0) discard(to.pop());
    to.producers.clear();
  }
}

void Outbox::begin(Lane& lane) const {
  lane.packed.clear();
  const PackedFrom from{self_};
  lane.packed.append(std::as_bytes(std::span(&from, 1)));
}

/// Appends the message to the lane's buffer; returns its size in bytes. If it does not fit, nothing
/// is changed. If serialize() throws, the message is gone.
std::size_t Outbox::write(Lane& lane, Envelope* message, bool charged) {
  attached_.clear();
  const std::span<std::byte> room = lane.packed.room();
  PackedHeader header{0,
                      message->epoch,
                      message->action->id(),
                      message->source,
                      message->target,
                      message->trace << PackedHeader::n_flags |
                          (message->counted ? PackedHeader::counted : 0U) |
                          (charged ? PackedHeader::charged : 0U) |
                          (message->prioritised ? PackedHeader::prioritised : 0U)};
  Writer write(room, &attached_);
  write(header);
  try {
    message->action->pack(*message, write);
  } catch (...) {
    discard(message);
    throw;
  }
  const std::size_t n_bytes = write.n_bytes();
  if (n_bytes <= room.size()) {
    header.n_bytes = n_bytes - sizeof header;
    std::memcpy(room.data(), &header, sizeof header);
  }
  return n_bytes;
}

/// A message that is too large for the usual buffer gets a buffer of its own size.
void Outbox::make_room(Lane& lane, ProcessId process, std::size_t n_bytes) {
  if (lane.packed.size() + n_bytes > most_bytes && lane.packed.size() > sizeof(PackedFrom)) {
    send_packed(lane, process);
    begin(lane);
  }
  const std::size_t all = lane.packed.size() + n_bytes;
  lane.packed.reserve(all > most_bytes ? all
                                       : std::clamp(2 * lane.packed.capacity(), all, most_bytes));
}

void Outbox::pack(Lane& lane, ProcessId process, Envelope* message, bool charged) {
  if (lane.packed.capacity() == 0) lane.packed.reserve(first_bytes);
  if (lane.packed.empty()) begin(lane);
  std::size_t n_bytes = write(lane, message, charged);
  while (n_bytes > lane.packed.room().size()) {
    make_room(lane, process, n_bytes);
    n_bytes = write(lane, message, charged);
  }
  const std::uint64_t all = n_bytes + attached_.n_bytes;
  bytes_sent_ += all;
  if (charged) lane.under_way += credit_of(all);
  if (!attached_.parts.empty()) [[unlikely]] {
    send_parcel(lane, process, message, n_bytes);
    return;
  }
  lane.packed.resize(lane.packed.size() + n_bytes);
  discard(message);
  holds_packed_ = true;
  if (lane.packed.size() >= flush_bytes || one_by_one_) send_packed(lane, process);
}

/// The message is in the buffer's free space behind the lane's contents, which stay.
void Outbox::send_parcel(Lane& lane, ProcessId process, Envelope* message, std::size_t n_bytes) {
  Parcel parcel;
  parcel.head.reserve(sizeof(PackedFrom) + n_bytes);
  parcel.head.append({lane.packed.data(), sizeof(PackedFrom)});
  parcel.head.append(lane.packed.room().first(n_bytes));
  parcel.parts = attached_.parts;
  parcel.keeper = std::make_shared<Sent>(message, std::move(attached_.keepers));
  attached_.clear();
  machine_.send(self_, process, std::move(parcel));
}

void Outbox::send_packed(Lane& lane, ProcessId process) {
  machine_.send(self_, process, std::move(lane.packed));
  lane.packed.clear();
}

bool Outbox::flush() {
  if (!holds_packed_) return false;
  holds_packed_ = false;
  for (std::size_t process = 0; process < lanes_.size(); ++process) {
    if (!lanes_[process].packed.empty())
      send_packed(lanes_[process], ProcessId{static_cast<std::int32_t>(process)});
  }
  return true;
}

}  // namespace tess::detail
