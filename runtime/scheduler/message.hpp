// An envelope with one payload: its construction, packing and release.
#pragma once

#include "runtime/messages/envelope.hpp"
#include "runtime/scheduler/block.hpp"

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

}  // namespace tess::detail
