// A queue that many threads push to and one thread empties: the inbox of a PE and the return stack
// of a pool. It links the elements themselves, so it never allocates. Producers push onto a Treiber
// stack; the consumer takes all of it with one exchange and reverses it. No single node is ever
// popped, hence there is no ABA problem.
//
//     push c ─► c ─► b ─► a          take_all()  ─►  a ─► b ─► c, and the stack is empty
//
// Links of one producer come out in the order in which it pushed them.
#pragma once

#include "runtime/base/link.hpp"

#include <atomic>

namespace tess::detail {

/// Any thread pushes; take_all() and take_all_reversed() belong to one thread at a time.
class MpscQueue {
 public:
  MpscQueue() = default;
  MpscQueue(const MpscQueue&) = delete;
  MpscQueue& operator=(const MpscQueue&) = delete;
  ~MpscQueue() = default;

  /// Returns true if the queue was empty: then this producer, and no other, has to wake the
  /// consumer.
  bool push(Link* link) noexcept { return push_chain(link, link); }

  /// Pushes last, …, first; take_all_reversed() returns `first` first. Returns true as push() does.
  bool push_chain(Link* first, Link* last) noexcept {
    Link* head = head_.load(std::memory_order_relaxed);
    do {
      last->next = head;
      // seq_cst, not release: together with Parker::wake() it ensures that no wake-up is lost.
    } while (!head_.compare_exchange_weak(head, first, std::memory_order_seq_cst,
                                          std::memory_order_relaxed));
    return head == nullptr;
  }

  /// Everything pushed so far, oldest first; null if there is nothing.
  [[nodiscard]] Link* take_all() noexcept {
    Link* newest = take_all_reversed();
    Link* oldest = nullptr;
    while (newest != nullptr) {
      Link* const older = newest->next;
      newest->next = oldest;
      oldest = newest;
      newest = older;
    }
    return oldest;
  }

  /// Everything pushed so far, newest first: for consumers that do not need the order.
  [[nodiscard]] Link* take_all_reversed() noexcept {
    // The load before the exchange keeps the cache line shared while the queue is empty.
    if (head_.load(std::memory_order_relaxed) == nullptr) return nullptr;
    return head_.exchange(nullptr, std::memory_order_acquire);  // partner: push_chain()
  }

  /// Exact for a consumer that has announced its sleep (Parker); otherwise only a hint.
  [[nodiscard]] bool empty() const noexcept {
    return head_.load(std::memory_order_seq_cst) == nullptr;
  }

 private:
  std::atomic<Link*> head_{nullptr};
};

}  // namespace tess::detail
