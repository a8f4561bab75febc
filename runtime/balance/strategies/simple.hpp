// Strategies that look at no load: for comparison, and to shake applications.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Every element stays.
[[nodiscard]] Assignment none(const Snapshot& snapshot);
/// Every element to the next PE, where it fits.
[[nodiscard]] Assignment rotate(const Snapshot& snapshot);
/// Every element to a random PE, where it fits.
[[nodiscard]] Assignment random(const Snapshot& snapshot, std::uint64_t seed);

}  // namespace tess::balance
