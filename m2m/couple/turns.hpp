// Applications by one coupling that write the same member of the target take turns, in the order of
// the calls. If two ran at once, messages of the later round could arrive first and wait in Rounds
// for the other round. They are done as far as their epoch knows, so its task would end before its
// values are written. The copies of a handle share this, on their PE.
//
// An application that is caused by the one whose turn it is, such as by received(), would wait for
// it, and the epoch of that one for this application: it is refused.
#pragma once

#include "runtime/core/check.hpp"
#include "runtime/future.hpp"
#include "runtime/here.hpp"
#include "runtime/task.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

namespace tess::m2m {

class Turns {
 public:
  /// Ends when it is the caller's turn in the channel, which it then passes on.
  Task take(std::uint64_t channel) {
    const auto [at, is_free] = turns_.try_emplace(channel);
    if (is_free) co_return;
    TESS_CHECK(at->second.epoch != my_epoch(),
               "a coupling is applied by what an application to the same member of the target "
               "causes, such as received(): each would wait for the other; start it after the "
               "co_await of the first, or with another Take");
    Future<void> turn;
    at->second.waiting.push_back(turn.callback());
    co_await turn;
  }
  /// It is the caller's turn, and what this epoch causes belongs to it. Called in the epoch.
  void begins(std::uint64_t channel) { turns_.at(channel).epoch = my_epoch(); }
  void pass_on(std::uint64_t channel) {
    const auto at = turns_.find(channel);
    at->second.epoch.reset();
    std::deque<Callback<void>>& waiting = at->second.waiting;
    if (waiting.empty()) {
      turns_.erase(at);
      return;
    }
    const Callback<void> next = std::move(waiting.front());
    waiting.pop_front();
    next();
  }

 private:
  struct Turn {
    std::optional<EpochId> epoch{};        ///< that is under way
    std::deque<Callback<void>> waiting{};  ///< for their turns
  };
  /// Per channel where it is the turn of one.
  std::map<std::uint64_t, Turn> turns_;
};

}  // namespace tess::m2m
