// The messages that a PE may run: first those of negative priority, then those without a priority
// (or of priority 0), then those of positive priority. The middle ones are first in first out, in a
// growing ring of pointers. Such a message is touched only when its turn is near; it is then
// prefetched. Used by one thread.
#pragma once

#include "runtime/base/link.hpp"
#include "runtime/pe/queues/priority_queue.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace tess::detail {

class ReadyQueue {
 public:
  ReadyQueue() : ring_(std::make_unique_for_overwrite<Link*[]>(first_capacity)) {}
  ReadyQueue(const ReadyQueue&) = delete;
  ReadyQueue& operator=(const ReadyQueue&) = delete;
  ~ReadyQueue() = default;

  [[nodiscard]] bool empty() const { return head_ == tail_ && prioritised_.empty(); }
  [[nodiscard]] std::size_t size() const { return tail_ - head_ + prioritised_.size(); }
  /// Calls visit(link) for every message, in any order.
  void for_each(const auto& visit) const {
    for (std::size_t at = head_; at != tail_; ++at) visit(ring_[at & mask_]);
    prioritised_.for_each(visit);
  }

  void push(Link* link) {
    if (tail_ - head_ > mask_) [[unlikely]]
      grow();
    ring_[tail_++ & mask_] = link;
  }
  void push(Link* link, std::int64_t priority) {
    if (priority == 0) return push(link);
    prioritised_.push(link, priority);
  }

  /// The message without a priority that comes after n others, already prefetched; null if there is
  /// none. n is less than the prefetch distance.
  [[nodiscard]] Link* ahead(std::size_t n) const {
    return head_ + n < tail_ ? ring_[(head_ + n) & mask_] : nullptr;
  }

  /// Removes the next message; the queue must not be empty.
  Link* pop() {
    if (!prioritised_.empty()) [[unlikely]] {
      if (prioritised_.top() < 0 || head_ == tail_) return prioritised_.pop();
    }
    if (head_ + distance < tail_) {
      const char* soon = reinterpret_cast<const char*>(ring_[(head_ + distance) & mask_]);
      __builtin_prefetch(soon, 1);
      __builtin_prefetch(soon + 64, 1);
    }
    return ring_[head_++ & mask_];
  }

 private:
  static constexpr std::size_t first_capacity = 256;
  static constexpr std::size_t distance = 6;  // prefetch distance

  void grow() {
    const std::size_t n = tail_ - head_;
    auto larger = std::make_unique_for_overwrite<Link*[]>(2 * (mask_ + 1));
    for (std::size_t i = 0; i < n; ++i) larger[i] = ring_[(head_ + i) & mask_];
    ring_ = std::move(larger);
    mask_ = 2 * mask_ + 1;
    head_ = 0;
    tail_ = n;
  }

  std::unique_ptr<Link*[]> ring_;
  std::size_t mask_ = first_capacity - 1;
  std::size_t head_ = 0,
              tail_ = 0;  // counted from the start; the slot is the count modulo the capacity
  PriorityQueue prioritised_;
};

}  // namespace tess::detail
