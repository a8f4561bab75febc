// A PE's part in the audit of messages between PEs, and the fault that a test plants.
#pragma once

#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/pe/report/audit.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <cstdint>
#include <vector>

namespace tess::detail {

class Pe;

class MessageAudit {
 public:
  MessageAudit(const Pe& pe, const MessageFault& fault);

  /// Counts a message that leaves for another PE. Returns what is to go wrong with it.
  [[nodiscard]] MessageFault::Kind departs(PeId to, Envelope& message);
  void arrives(Envelope& message);
  [[nodiscard]] std::vector<AuditRow> rows() const { return audit_.rows(); }

  /// Copies the message by way of its bytes.
  [[nodiscard]] static Envelope* copy_of(Pe& pe, Envelope& message);

 private:
  const Pe& pe_;
  Audit audit_;
  const MessageFault fault_;
  std::uint64_t n_users_messages_ = 0;  // sent to other PEs
};

}  // namespace tess::detail
