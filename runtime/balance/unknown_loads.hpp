// Elements whose load is not known: they ran before they were measured, or have not run yet. They
// are taken to weigh what the others weigh on average, and stay where they are until a whole phase
// of theirs was seen: no strategy takes them for idle.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// How many loads are known.
[[nodiscard]] std::size_t n_known_loads(const Snapshot& snapshot);

/// Puts the mean of the known loads in place of those that are not; 0 where none is known.
void assume_mean_loads(Snapshot& snapshot);

/// What a strategy works on: mean loads where they are not known, and these elements pinned.
[[nodiscard]] Snapshot with_unknown_pinned(Snapshot snapshot);

}  // namespace tess::balance
