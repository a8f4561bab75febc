// How much migrating work each PE should get: for strategies that cut space or a graph into parts.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Work at speed 1 for each PE, such that all PEs that get any are done at the same time; their
/// background and pinned elements come first. Sums to the load of the elements that migrate; equal
/// shares of 1 where these have none.
[[nodiscard]] std::vector<double> capacities(const Snapshot& snapshot);

/// What each element weighs against these capacities: its load; where no element that migrates has
/// any, n_pes / n_elements.
[[nodiscard]] std::vector<double> weights(const Snapshot& snapshot);

}  // namespace tess::balance
