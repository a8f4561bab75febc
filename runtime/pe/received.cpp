// Messages that arrive from other processes: they are unpacked where they arrive, passed to their
// PE, and repaid once they have run.
#include "runtime/core/check.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/peers.hpp"
#include "runtime/pe/queues/outbox.hpp"
#include "runtime/wire/messages/read_all.hpp"

#include <numeric>

namespace tess::detail {
namespace {

/// Credit that another PE repays.
struct Credit {
  PeId from;
  std::uint64_t amount = 0;
};
void credit_arrives(Pe& pe, Credit&& credit) {
  pe.peers().on_repaid(credit.from, credit.amount);
}

/// Lets a producer on this PE continue.
struct Room {
  ProcessId process;
};
void room_arrives(Pe& pe, Room&& room) {
  if (pe.peers().outbox().go_on_one(room.process)) send_system<&room_arrives>(pe, pe.id(), room);
}

/// `n_bytes` includes the attached parts.
Envelope* unpack(Pe& pe, PeId sender, const PackedHeader& header, Reader& body,
                 std::uint64_t n_bytes) {
  const auto& action = static_cast<const Action&>(Registry::at(header.action));
  Envelope* message = read_all(
      body, [&action] { return plain_name(action.name()); },
      [&pe, &action](Reader& arguments) { return action.unpack(pe, arguments); });
  message->action = &action;
  message->epoch = header.epoch;
  message->source = header.source;
  message->target = header.target;
  message->counted = (header.trace_and_flags & PackedHeader::counted) != 0;
  message->prioritised = (header.trace_and_flags & PackedHeader::prioritised) != 0;
  message->trace = header.trace_and_flags >> PackedHeader::n_flags;
  message->sender = sender;
  if ((header.trace_and_flags & PackedHeader::charged) != 0) message->charge = credit_of(n_bytes);
  return message;
}

}  // namespace

void Peers::receive(std::span<const std::byte> bytes) {
  const RunsOn here(pe_);
  Reader read(bytes);
  const auto from = read.take<PackedFrom>();
  while (read.remaining() != 0) {
    const auto header = read.take<PackedHeader>();
    Reader body(read.view(header.n_bytes));
    const std::uint64_t n_bytes = sizeof header + header.n_bytes;
    pe_.hand_over(unpack(pe_, from.sender, header, body, n_bytes), n_bytes);
  }
}

Envelope* Peers::place(std::span<const std::byte> head, std::span<const std::uint64_t> sizes,
                       std::vector<std::span<std::byte>>& taken) {
  const RunsOn here(pe_);
  Reader read(head);
  const auto from = read.take<PackedFrom>();
  const auto header = read.take<PackedHeader>();
  Places places{sizes, taken};
  Reader body(read.view(header.n_bytes), &places);
  const std::uint64_t attached = std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0});
  Envelope* message =
      unpack(pe_, from.sender, header, body, sizeof header + header.n_bytes + attached);
  TESS_CHECK(taken.size() == sizes.size(), plain_name(message->action->name()),
             ": the arguments read back leave ", sizes.size() - taken.size(), " of ", sizes.size(),
             " large vectors; does serialize() read what it writes?");
  return message;
}

void Peers::repay(PeId sender, std::uint32_t charge) {
  if (const std::uint64_t amount = outbox_->owe(sender, charge); amount != 0)
    send_system<&credit_arrives>(pe_, sender, Credit{pe_.id(), amount});
}

void Peers::on_repaid(PeId from, std::uint64_t amount) {
  const ProcessId process = pe_.machine().process_of(from);
  outbox_->repaid(process, amount);
  if (outbox_->holds()) hold();
  if (outbox_->awaited(process)) send_system<&room_arrives>(pe_, pe_.id(), Room{process});
}

}  // namespace tess::detail
