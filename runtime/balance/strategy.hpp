// Strategies: pure functions from a snapshot to an assignment. Elements that do not migrate stay;
// no move takes a PE above its memory limit.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <functional>
#include <string_view>

namespace tess::balance {

/// A strategy, ours or the user's.
using Strategy = std::function<Assignment(const Snapshot&)>;

/// By name: none, rotate, random, greedy, refine. Throws Error that lists the names for any other.
[[nodiscard]] Strategy make_strategy(std::string_view name, std::uint64_t seed);

/// Every element to the next PE, where it fits.
[[nodiscard]] Assignment rotate(const Snapshot& snapshot);
/// Every element to a random PE, where it fits.
[[nodiscard]] Assignment random(const Snapshot& snapshot, std::uint64_t seed);
/// Heaviest element first, to the PE that is done soonest with it; the present placement if limits
/// leave no room.
[[nodiscard]] Assignment greedy(const Snapshot& snapshot);
/// Moves from the slowest PE, one at a time, until max/average is at most `tolerance` or no move
/// helps.
[[nodiscard]] Assignment refine(const Snapshot& snapshot, double tolerance = 1.03);

}  // namespace tess::balance
