#include "runtime/pe/queues/priority_queue.hpp"

#include <algorithm>

namespace tess::detail {
namespace {

/// Orders the heap: its first entry comes before all others.
constexpr auto later = [](const auto& a, const auto& b) {
  return a.priority != b.priority ? a.priority > b.priority : a.number > b.number;
};

}  // namespace

void PriorityQueue::push(Link* link, std::int64_t priority) {
  link->next = nullptr;
  ++size_;
  if (const std::uint32_t at = newest_[slot(priority)]; at < runs_.size()) {
    Run& run = runs_[at];
    if (run.first != nullptr && run.priority == priority) {
      run.last->next = link;
      run.last = link;
      return;
    }
  }
  begin_run(link, priority);
}

void PriorityQueue::begin_run(Link* link, std::int64_t priority) {
  if (unused_.empty()) {
    unused_.push_back(static_cast<std::uint32_t>(runs_.size()));
    runs_.emplace_back();
  }
  const std::uint32_t at = unused_.back();
  unused_.pop_back();
  runs_[at] = Run{priority, link, link};
  newest_[slot(priority)] = at;
  heap_.push_back(QueuedRun{priority, n_begun_++, at});
  std::push_heap(heap_.begin(), heap_.end(), later);
}

Link* PriorityQueue::pop() {
  Run& run = runs_[heap_.front().run];
  Link* const link = run.first;
  run.first = link->next;
  --size_;
  if (run.first == nullptr) {
    end_first_run();
  } else {
    const char* soon = reinterpret_cast<const char*>(run.first);
    __builtin_prefetch(soon, 1);
    __builtin_prefetch(soon + 64, 1);
  }
  return link;
}

void PriorityQueue::end_first_run() {
  unused_.push_back(heap_.front().run);
  std::pop_heap(heap_.begin(), heap_.end(), later);
  heap_.pop_back();
}

}  // namespace tess::detail
