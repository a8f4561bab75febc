#include "runtime/pe/auditing.hpp"

#include "runtime/core/serialize.hpp"

namespace tess::detail {
namespace {

/// The same message once more, by way of its bytes.
Envelope* copy_of(Pe& pe, Envelope* message) {
  Buffer bytes;
  Writer write(bytes);
  message->action->pack(*message, write);
  Reader read(std::span<const std::byte>(bytes.data(), bytes.size()));
  Envelope* copy = message->action->unpack(pe, read);
  copy->action = message->action;
  copy->epoch = message->epoch;
  copy->source = message->source;
  copy->target = message->target;
  copy->counted = message->counted;
  copy->prioritised = message->prioritised;
  copy->trace = message->trace;
  copy->sender = message->sender;
  return copy;
}

}  // namespace

void Pe::start_audit(const MessageFault& fault) {
  audit_ = std::make_unique<Auditing>(Auditing{Audit(id_), fault});
}

std::vector<AuditRow> Pe::audit_rows() const {
  return audit_ ? audit_->audit.rows() : std::vector<AuditRow>();
}

/// A message that no epoch counts may be under way when the others have arrived: it is left out.
/// The number travels in the field of the trace.
bool Pe::audit_departure(PeId to, Envelope* message) {
  if (!message->counted || (to == id_ && !intercepts_)) return true;
  message->sender = id_;
  message->trace = audit_->audit.sent(to, message->action->id());
  if (audit_->fault.kind == MessageFault::Kind::none || id_.value != 0 || to == id_ ||
      message->action->traffic != Traffic::user || ++audit_->n_users_messages != audit_->fault.nth)
    return true;
  if (audit_->fault.kind == MessageFault::Kind::lost) {
    discard(message);
    return false;
  }
  carry(to, copy_of(*this, message));
  return true;
}

void Pe::audit_arrival(Envelope* message) {
  if (message->trace == 0) return;
  audit_->audit.received(message->sender, message->action->id(), message->trace);
  message->trace = 0;  // the next hop has its own number
}

void Pe::audit_arrivals(Link* first) {
  for (Link* one = first; one != nullptr; one = one->next)
    audit_arrival(static_cast<Envelope*>(one));
}

}  // namespace tess::detail
