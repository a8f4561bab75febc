// An envelope with one payload: its construction, packing and release; and the function that handles
// such a message where it arrives.
#pragma once

#include "runtime/pe/block.hpp"
#include "runtime/pe/completion/counted.hpp"
#include "runtime/wire/messages/envelope.hpp"

namespace tess::detail {

template <class Payload>
struct Message final : Envelope {
  Payload payload;

  explicit Message(Payload&& p) : payload(std::move(p)) {}

  static Message* make(Pe& pe, const Action& action, Payload&& payload) {
    auto* message = new (allocate_block(pe, sizeof(Message))) Message(std::move(payload));
    message->action = &action;
    return message;
  }
  static void destroy(Envelope* envelope) {
    static_cast<Message*>(envelope)->~Message();
    release_message(envelope);
  }
  static void pack(Envelope& envelope, Writer& ar) { ar(static_cast<Message&>(envelope).payload); }
  static Envelope* unpack(Pe& pe, Reader& ar) {
    // Constructed in place: the bytes of a large vector arrive later, at its present address.
    auto* message = new (allocate_received(pe, sizeof(Message))) Message(Payload{});
    ar(message->payload);
    return message;
  }
};

/// The type of a handler: what it gets is a part of its PE, the payload, and, where its messages
/// count in the epoch in which they are sent, the Counted of the message. Such a message is counted
/// as sent by whatever sends it, and as processed when the handler has returned, unless the handler
/// keeps the Counted.
template <class F>
struct HandlerType;
template <class R, class P>
struct HandlerType<void (*)(R&, P&&)> {
  using Receiver = R;
  using Payload = P;
  static constexpr bool counts = false;
  template <auto Handler>
  static void call(Pe& /*pe*/, EpochId /*epoch*/, R& receiver, P&& payload) {
    Handler(receiver, std::move(payload));
  }
};
template <class R, class P>
struct HandlerType<void (*)(R&, P&&, Counted)> {
  using Receiver = R;
  using Payload = P;
  static constexpr bool counts = true;
  template <auto Handler>
  static void call(Pe& pe, EpochId epoch, R& receiver, P&& payload) {
    Handler(receiver, std::move(payload), Counted(pe.completion(), epoch));
  }
};

}  // namespace tess::detail
