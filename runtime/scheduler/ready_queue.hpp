// The messages a PE may run, first in first out. Intrusive, so that it never allocates; one
// thread's alone.
#pragma once

#include "runtime/base/link.hpp"

namespace tess {

class ReadyQueue {
 public:
  [[nodiscard]] bool empty() const { return first_ == nullptr; }

  void push(Link* link) {
    link->next = nullptr;
    *last_ = link;
    last_ = &link->next;
  }

  /// Appends a whole list.
  void append(Link* first) {
    *last_ = first;
    while (*last_ != nullptr) last_ = &(*last_)->next;
  }

  /// The oldest; the queue must not be empty.
  Link* pop() {
    Link* link = first_;
    first_ = link->next;
    if (first_ == nullptr) last_ = &first_;
    return link;
  }

  ReadyQueue() = default;
  ReadyQueue(const ReadyQueue&) = delete;
  ReadyQueue& operator=(const ReadyQueue&) = delete;
  ~ReadyQueue() = default;

 private:
  Link* first_ = nullptr;
  Link** last_ = &first_;
};

}  // namespace tess
