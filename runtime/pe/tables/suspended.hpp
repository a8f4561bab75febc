// The suspended coroutines of one PE. They are listed so that a run that cannot continue can report
// what each waits for. The entries are parts of the coroutines' frames, so waiting allocates
// nothing.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/report/wait_reason.hpp"

#include <functional>

namespace tess::detail {

class TessElement;
using Element = TessElement;
struct Action;

/// One suspended coroutine.
struct Suspended {
  Element* element = nullptr;
  const Action* action = nullptr;
  EpochId epoch{};
  std::function<WaitReason()> waits_for;
  void* frame = nullptr;
  const bool* detached = nullptr;  ///< points into the frame: true if no Task holds the coroutine
  Suspended* before = nullptr;
  Suspended* after = nullptr;
};

/// Entries must not move while they are listed.
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
  /// The coroutine that has waited longest; null if there is none.
  [[nodiscard]] const Suspended* first() const { return first_; }
  void clear() { first_ = last_ = nullptr; }

 private:
  Suspended* first_ = nullptr;
  Suspended* last_ = nullptr;
};

/// Destroys all suspended coroutines, at the end of the run.
void end_all(SuspendedList& list);

}  // namespace tess::detail
