#include "runtime/pe/message_audit.hpp"

#include "runtime/core/serialize.hpp"
#include "runtime/pe/pe.hpp"

#include <span>

namespace tess::detail {

MessageAudit::MessageAudit(const Pe& pe, const MessageFault& fault)
    : pe_(pe), audit_(pe.id()), fault_(fault) {}

Envelope* MessageAudit::copy_of(Pe& pe, Envelope& message) {
  Buffer bytes;
  Writer write(bytes);
  message.action->pack(message, write);
  Reader read(std::span<const std::byte>(bytes.data(), bytes.size()));
  Envelope* copy = message.action->unpack(pe, read);
  copy->action = message.action;
  copy->epoch = message.epoch;
  copy->source = message.source;
  copy->target = message.target;
  copy->counted = message.counted;
  copy->prioritised = message.prioritised;
  copy->trace = message.trace;
  copy->sender = message.sender;
  return copy;
}

/// A message that no epoch counts may be under way when the others have arrived: it is left out.
/// The number travels in the field of the trace.
MessageFault::Kind MessageAudit::departs(PeId to, Envelope& message) {
  using Kind = MessageFault::Kind;
  if (!message.counted || (to == pe_.id() && !pe_.intercepts())) return Kind::none;
  message.sender = pe_.id();
  message.trace = audit_.sent(to, message.action->id());
  if (fault_.kind == Kind::none || pe_.id().value != 0 || to == pe_.id() ||
      message.action->traffic != Traffic::user || ++n_users_messages_ != fault_.nth)
    return Kind::none;
  return fault_.kind;
}

void MessageAudit::arrives(Envelope& message) {
  if (message.trace == 0) return;
  audit_.received(message.sender, message.action->id(), message.trace);
  message.trace = 0;  // the next hop has its own number
}

}  // namespace tess::detail
