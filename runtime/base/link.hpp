// The node of the project's queues. A message's header begins with it, so queues do not allocate.
#pragma once

namespace tess::detail {

/// An intrusive singly linked list node. A Link is in at most one queue at a time.
struct Link {
  Link* next = nullptr;
};

}  // namespace tess::detail
