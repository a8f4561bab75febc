// Elements with unknown loads: they ran before they were measured, or have not run yet. Each counts
// as the mean of the others and stays until a whole phase of it has been measured, so that no
// strategy treats it as idle.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// The number of known loads.
[[nodiscard]] std::size_t n_known_loads(const Snapshot& snapshot);

/// The load that is assumed for an unknown one: the mean of the known ones; 0 if none is known.
[[nodiscard]] double mean_load(const Snapshot& snapshot);

/// The input of a built-in strategy, which calculates with all loads: mean loads for elements of
/// unknown load, which are pinned.
[[nodiscard]] Snapshot with_unknown_pinned(Snapshot snapshot);

}  // namespace tess::balance
