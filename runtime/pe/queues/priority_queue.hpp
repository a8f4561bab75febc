// The messages of a PE that have a priority: the smallest number first, and first in first out
// among equal ones. A message joins the run of messages that were last pushed with its priority, so
// a few priorities cost little more than a list each. A heap orders the runs:
//
//     heap:  (-7, 1) (-7, 9) (3, 4) …        priority and number of the run; a pair occurs once
//               │
//     run:   first ─► … ─► last              linked through the messages
//
// A small table finds the newest run of a priority. It may forget one: then the next message of
// that priority begins a new run, whose number is greater, so the order is kept. Used by one
// thread.
#pragma once

#include "runtime/base/link.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tess::detail {

class PriorityQueue {
 public:
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// The priority of the next message; the queue must not be empty.
  [[nodiscard]] std::int64_t top() const { return heap_.front().priority; }

  void push(Link* link, std::int64_t priority);
  /// Removes the next message; the queue must not be empty.
  Link* pop();

  /// Calls visit(link) for every message, in any order.
  void for_each(const auto& visit) const {
    for (const QueuedRun& entry : heap_)
      for (const Link* link = runs_[entry.run].first; link != nullptr; link = link->next)
        visit(link);
  }

 private:
  struct QueuedRun {
    std::int64_t priority;
    std::uint64_t number;
    std::uint32_t run;
  };
  struct Run {
    std::int64_t priority = 0;
    Link* first = nullptr;  // null: not in use
    Link* last = nullptr;
  };
  static constexpr std::size_t n_slots = 64;

  [[nodiscard]] static std::size_t slot(std::int64_t priority) {
    return (static_cast<std::uint64_t>(priority) * 0x9e3779b97f4a7c15U) >> 58U;
  }
  void begin_run(Link* link, std::int64_t priority);
  void end_first_run();

  std::size_t size_ = 0;
  std::uint64_t n_begun_ = 0;
  std::vector<QueuedRun> heap_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> unused_;            // places in runs_
  std::array<std::uint32_t, n_slots> newest_{};  // a place in runs_: that of this priority, or not
};

}  // namespace tess::detail
