// Messages that come from other processes: unpacked where they arrive, and handed to their PE.
#include "runtime/check.hpp"
#include "runtime/scheduler/pe.hpp"

namespace tess {
namespace {

Envelope* unpack(Pe& pe, const PackedHeader& header, Reader& body) {
  const auto& action = static_cast<const Action&>(Registry::at(header.action));
  Envelope* message = action.unpack(pe, body);
  TESS_CHECK(body.remaining() == 0,
             plain_name(action.name()),
             ": the arguments read back leave ",
             body.remaining(),
             " of ",
             header.n_bytes,
             " bytes; does serialize() read what it writes?");
  message->action = &action;
  message->epoch = header.epoch;
  message->source = header.source;
  message->target = header.target;
  message->counted = (header.trace_and_counted & 1U) != 0;
  message->trace = header.trace_and_counted >> 1U;
  return message;
}

}  // namespace

void Pe::receive(std::span<const std::byte> bytes) {
  const RunsOn here(*this);
  Reader read(bytes);
  [[maybe_unused]] const auto from = read.take<PackedFrom>();
  while (read.remaining() != 0) {
    const auto header = read.take<PackedHeader>();
    Reader body(read.view(header.n_bytes));
    hand_over(unpack(*this, header, body), header.n_bytes);
  }
}

Envelope* Pe::place(std::span<const std::byte> head,
                    std::span<const std::uint64_t> sizes,
                    std::vector<std::span<std::byte>>& taken) {
  const RunsOn here(*this);
  Reader read(head);
  [[maybe_unused]] const auto from = read.take<PackedFrom>();
  const auto header = read.take<PackedHeader>();
  Places places{sizes, taken};
  Reader body(read.view(header.n_bytes), &places);
  Envelope* message = unpack(*this, header, body);
  TESS_CHECK(taken.size() == sizes.size(),
             plain_name(message->action->name()),
             ": the arguments read back leave ",
             sizes.size() - taken.size(),
             " of ",
             sizes.size(),
             " large vectors; does serialize() read what it writes?");
  return message;
}

void Pe::hand_over(Envelope* message, std::size_t n_bytes) {
  if (message->target == id_) {
    ready_.push(message);
  } else {
    machine_.post(id_, message->target, message, n_bytes, message->action->traffic);
  }
}

}  // namespace tess
