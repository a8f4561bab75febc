// Applications by one coupling that write the same member of the target take turns, in the order of
// the calls. If two ran at once, messages of the later round could arrive first and wait in Rounds
// for the other round. They are done as far as their epoch knows, so its task would end before its
// values are written. The copies of a handle share this, on their PE.
#pragma once

#include "runtime/future.hpp"
#include "runtime/task.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <utility>

namespace tess::m2m {

class Turns {
 public:
  /// Ends when it is the caller's turn in the channel, which it then passes on.
  Task take(std::uint64_t channel) {
    if (waiting_.try_emplace(channel).second) co_return;
    Future<void> turn;
    waiting_.at(channel).push_back(turn.callback());
    co_await turn;
  }
  void pass_on(std::uint64_t channel) {
    const auto at = waiting_.find(channel);
    if (at->second.empty()) {
      waiting_.erase(at);
      return;
    }
    const Callback<void> next = std::move(at->second.front());
    at->second.pop_front();
    next();
  }

 private:
  /// Per channel where it is the turn of one: those that wait for theirs.
  std::map<std::uint64_t, std::deque<Callback<void>>> waiting_;
};

}  // namespace tess::m2m
