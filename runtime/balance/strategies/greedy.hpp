// Greedy: the best balance for its cost, at the price of moving nearly everything.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Heaviest element first, each to the PE that is done soonest with it (Graham 1969, "LPT"; within
/// 4/3 of the best where speeds are equal). O(n log n + n log n_pes) with few distinct speeds.
[[nodiscard]] Assignment greedy(const Snapshot& snapshot);

/// These elements, in this order, each to the PE that is done soonest with it and has room; all
/// others stay.
[[nodiscard]] Assignment place_soonest(const Snapshot& snapshot,
                                       const std::vector<std::size_t>& elements);

/// Positions of the elements that migrate, heaviest first, ties in order.
[[nodiscard]] std::vector<std::size_t> heaviest_first(const Snapshot& snapshot);

}  // namespace tess::balance
