// Strategies that ignore loads, for comparison and for testing applications.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Every element stays.
[[nodiscard]] Assignment none(const Snapshot& snapshot);
/// Moves every element to the next PE, if it fits there.
[[nodiscard]] Assignment rotate(const Snapshot& snapshot);
/// Moves every element to a random PE, if it fits there.
[[nodiscard]] Assignment random(const Snapshot& snapshot, std::uint64_t seed);

}  // namespace tess::balance
