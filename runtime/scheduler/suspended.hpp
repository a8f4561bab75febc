// The coroutines of one PE that wait for something. Kept so that a run that stands still can report
// who waits for what. The entries are parts of the coroutines' frames, so that waiting allocates
// nothing.
#pragma once

#include "runtime/core/ids.hpp"

#include <functional>
#include <string>

namespace tess {

class Element;
struct Action;

/// One coroutine that waits.
struct Suspended {
  Element* element = nullptr;
  const Action* action = nullptr;
  EpochId epoch{};
  std::function<std::string()> waits_for;
  void* frame = nullptr;
  const bool* detached = nullptr;  ///< in the frame: no Task holds the coroutine
  Suspended* before = nullptr;
  Suspended* after = nullptr;
};

/// Entries stay where they are until they are taken out.
class SuspendedList {
 public:
  SuspendedList() = default;
  SuspendedList(const SuspendedList&) = delete;
  SuspendedList& operator=(const SuspendedList&) = delete;
  ~SuspendedList() = default;

  void insert(Suspended& one) {
    one.before = last_;
    one.after = nullptr;
    (last_ != nullptr ? last_->after : first_) = &one;
    last_ = &one;
  }
  void erase(Suspended& one) {
    (one.before != nullptr ? one.before->after : first_) = one.after;
    (one.after != nullptr ? one.after->before : last_) = one.before;
  }
  /// The one that has waited longest; null if none waits.
  [[nodiscard]] const Suspended* first() const { return first_; }
  void clear() { first_ = last_ = nullptr; }

 private:
  Suspended* first_ = nullptr;
  Suspended* last_ = nullptr;
};

/// Frees them all: the run ends before they do.
void end_all(SuspendedList& list);

}  // namespace tess
