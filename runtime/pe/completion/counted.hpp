// Counting by construction. An epoch ends when as many of its messages are processed as were sent,
// so one that is forgotten makes a run hang, and one that is counted too early makes an epoch end
// before its work. So nothing counts by hand: a message that waits on a PE, or runs there, is held
// by a Counted, whose end counts it as processed on that PE.
//
//     sent(…)      it is made here, and stays here               counts it as sent
//     departs(…)   it is made here, and leaves for another PE    counts it as sent
//     Counted(…)   it has arrived, and was counted as sent where it came from
//     leave()      it goes on to another PE, with the number of its epoch
//     ~Counted()   it is done, or dropped                        counts it as processed
//
// A message that travels carries the number of its epoch only. Messages to handlers do all this by
// themselves (scheduler/message.hpp).
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/completion/completion.hpp"

#include <utility>

namespace tess::detail {

/// A message of a user, or something that its epoch waits for like one, while it is on a PE. Not
/// counted in epoch 0, which counts hops.
class Counted {
 public:
  Counted() = default;
  Counted(Completion& completion, EpochId epoch) : completion_(&completion), epoch_(epoch) {}
  [[nodiscard]] static Counted sent(Completion& completion, EpochId epoch) {
    completion.sent(epoch);
    return {completion, epoch};
  }
  static EpochId departs(Completion& completion, EpochId epoch) {
    completion.sent(epoch);
    return epoch;
  }

  Counted(Counted&& other) noexcept : completion_(other.completion_), epoch_(other.leave()) {}
  Counted& operator=(Counted&& other) noexcept {
    Counted taken(std::move(other));
    std::swap(completion_, taken.completion_);
    std::swap(epoch_, taken.epoch_);
    return *this;  // what it held until now ends
  }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() {
    if (epoch_.value != 0) completion_->processed_by_call(epoch_);
  }

  [[nodiscard]] EpochId epoch() const { return epoch_; }
  EpochId leave() { return std::exchange(epoch_, EpochId{}); }
  /// Ends it now, inline: the destructor does the same by a call, since it stands on many paths.
  void done() {
    if (epoch_.value != 0) completion_->processed(leave());
  }

 private:
  Completion* completion_ = nullptr;
  EpochId epoch_{};
};

/// Keeps the run going as a message that is under way does: a hop of epoch 0, from its construction
/// to its end.
class RunHold {
 public:
  explicit RunHold(Completion& completion) : completion_(&completion) { completion.hop_sent(); }
  RunHold(RunHold&& other) noexcept : completion_(std::exchange(other.completion_, nullptr)) {}
  RunHold(const RunHold&) = delete;
  RunHold& operator=(const RunHold&) = delete;
  RunHold& operator=(RunHold&&) = delete;
  ~RunHold() {
    if (completion_ != nullptr) completion_->hop_processed();
  }

 private:
  Completion* completion_;
};

}  // namespace tess::detail
