// Greedy: the best balance for its cost, but it moves nearly every element.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Places the heaviest element first, each on the PE that finishes first with it (Graham 1969,
/// "LPT"; within 4/3 of the optimum for equal speeds). O(n log n + n log n_pes) with few distinct
/// speeds.
[[nodiscard]] Assignment greedy(const Snapshot& snapshot);

/// Places these elements in this order, each on the PE with room that finishes first with it; all
/// others stay.
[[nodiscard]] Assignment place_soonest(const Snapshot& snapshot,
                                       const std::vector<std::size_t>& elements);

/// Positions of the elements that migrate, heaviest first, ties in order.
[[nodiscard]] std::vector<std::size_t> heaviest_first(const Snapshot& snapshot);

}  // namespace tess::balance
