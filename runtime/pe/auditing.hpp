// A PE's part in the audit of messages between PEs, and the fault that a test plants.
#pragma once

#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/watch/report/audit.hpp"

#include <cstdint>

namespace tess::detail {

struct Pe::Auditing {
  Audit audit;
  MessageFault fault;
  std::uint64_t n_users_messages = 0;  // sent to other PEs
};

}  // namespace tess::detail
