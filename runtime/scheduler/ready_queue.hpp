// The messages that a PE may run, first in first out, in a growing ring of pointers. A message is
// touched only when its turn is near; it is then prefetched. Used by one thread.
#pragma once

#include "runtime/base/link.hpp"

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

  [[nodiscard]] bool empty() const { return head_ == tail_; }
  [[nodiscard]] std::size_t size() const { return tail_ - head_; }
  /// Calls visit(link) for every message, the oldest first.
  void for_each(const auto& visit) const {
    for (std::size_t at = head_; at != tail_; ++at) visit(ring_[at & mask_]);
  }

  void push(Link* link) {
    if (tail_ - head_ > mask_) [[unlikely]]
      grow();
    ring_[tail_++ & mask_] = link;
  }

  /// The message whose turn comes after n others, already prefetched; null if there is none. n is
  /// less than the prefetch distance.
  [[nodiscard]] Link* ahead(std::size_t n) const {
    return head_ + n < tail_ ? ring_[(head_ + n) & mask_] : nullptr;
  }

  /// Removes the oldest message; the queue must not be empty.
  Link* pop() {
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
};

}  // namespace tess::detail
