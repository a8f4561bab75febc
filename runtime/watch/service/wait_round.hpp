// A round of questions about what waits. A process asks its PEs, and process 0 asks the processes of
// the job. Each answers once. The round ends when all have answered or at a deadline; then those
// that have not answered are named. The service guards it with its mutex.
//
//     PEs of a process ──► its WaitRound ──► one answer of the process ──► WaitRound of process 0
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/report/waiting.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tess::detail {

class Runtime;

/// What one PE answers, one process, or all processes of the job.
struct WaitAnswer {
  Waits waits;
  std::vector<PeId> silent;  ///< PEs that have not answered
  /// An entry method has begun lately, so the job does not hang; a process then answers nothing
  /// else.
  bool active = false;
};

class WaitRound {
 public:
  /// `n` PEs or processes are asked.
  WaitRound(std::uint64_t number, std::size_t n) : number_(number), answered_(n), n_missing_(n) {}

  [[nodiscard]] std::uint64_t number() const { return number_; }
  [[nodiscard]] bool complete() const { return n_missing_ == 0; }
  [[nodiscard]] bool ended() const { return ended_; }

  /// The i-th of those that are asked answers; a second answer of it has no effect. Returns true at
  /// the last of the answers.
  [[nodiscard]] bool take(std::size_t i, WaitAnswer&& answer) {
    if (answered_.at(i)) return false;
    answered_[i] = true;
    sum_.waits.merge(std::move(answer.waits));
    sum_.silent.insert(sum_.silent.end(), answer.silent.begin(), answer.silent.end());
    sum_.active = sum_.active || answer.active;
    return --n_missing_ == 0;
  }
  /// Ends the round: returns the sum of the answers, once. Calls missing(i, sum) before for each
  /// that has not answered.
  template <class Missing>
  [[nodiscard]] WaitAnswer end(const Missing& missing) {
    ended_ = true;
    for (std::size_t i = 0; i < answered_.size(); ++i)
      if (!answered_[i]) missing(i, sum_);
    return std::move(sum_);
  }

 private:
  const std::uint64_t number_;
  std::vector<bool> answered_;
  std::size_t n_missing_;
  bool ended_ = false;
  WaitAnswer sum_;
};

/// The words of a report: what waits, and what an audit found.
[[nodiscard]] std::string text_of(const Runtime& runtime, WaitAnswer&& answer);

/// What all PEs of a simulated machine answer at a virtual time, without messages. On PE 0.
[[nodiscard]] WaitAnswer answer_of_all(Runtime& runtime, Time now);

}  // namespace tess::detail
