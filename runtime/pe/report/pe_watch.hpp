// What a PE runs, as a watching thread sees it from outside (--hang-report). The PE publishes the
// element and the entry method that it runs; while another thread reads the element's name, the PE
// does not leave the entry method, so the element stays.
//
//     PE         element_ = e   … entry method …   element_ = null, while looked_at_: wait
//     watcher    looked_at_ = true, e = element_, reads e's name, looked_at_ = false
//
// Both sides store one flag and then load the other's, in one order for all (seq_cst): either the
// watcher sees that the PE has left, or the PE sees that it is looked at. Calls of entry methods
// inside others are not published: the outermost is what the PE is in.
#pragma once

#include "runtime/base/ticks.hpp"

#include <atomic>
#include <cstdint>
#include <thread>

namespace tess::detail {

class TessElement;
using Element = TessElement;
struct Action;

class PeWatch {
 public:
  // On the PE's thread.

  /// An entry method of an element begins, or code of the main program (null).
  void enters(const Element* element, const Action* action) {
    // relaxed: a number for the watcher, which reads nothing else by it; only this thread writes
    // it.
    n_entered_.store(n_entered_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (depth_++ != 0) return;
    action_.store(action, std::memory_order_relaxed);  // ordered by element_; it is static
    began_.store(read_ticks(), std::memory_order_relaxed);
    element_.store(element);
  }
  void leaves() {
    if (--depth_ != 0) return;
    began_.store(0, std::memory_order_relaxed);
    element_.store(nullptr);
    while (looked_at_.load()) std::this_thread::yield();
  }

  // On any thread.

  /// The number of entry methods that have begun.
  [[nodiscard]] std::uint64_t n_entered() const {
    return n_entered_.load(std::memory_order_relaxed);  // partner: enters()
  }
  /// The last entry method that began; null if none has.
  [[nodiscard]] const Action* last() const { return action_.load(std::memory_order_relaxed); }

  // On one thread at a time.

  /// Calls visit(element, action, seconds) if an entry method runs; the element is null for the
  /// main program. The PE is held until `visit` returns.
  template <class Visit>
  void look(const Visit& visit) {
    looked_at_.store(true);
    const Element* const element = element_.load();
    const std::uint64_t began = began_.load(std::memory_order_relaxed);
    if (began != 0) {
      const std::uint64_t now = read_ticks();
      visit(element, action_.load(std::memory_order_relaxed),
            static_cast<double>(now > began ? now - began : 0) * seconds_per_tick());
    }
    looked_at_.store(false);
  }

 private:
  std::atomic<std::uint64_t> n_entered_{0};
  std::atomic<const Action*> action_{nullptr};
  std::atomic<std::uint64_t> began_{0};  // ticks; 0: no entry method runs
  std::atomic<const Element*> element_{nullptr};
  std::atomic<bool> looked_at_{false};
  unsigned depth_ = 0;
};

}  // namespace tess::detail
