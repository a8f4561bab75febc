// What a queue of ours links: the message's header begins with it, so that no queue allocates.
#pragma once

namespace tess {

/// An intrusive singly linked list node. A Link is in at most one queue at a time.
struct Link {
  Link* next = nullptr;
};

}  // namespace tess
