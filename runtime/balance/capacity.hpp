// How much migrating work each PE should get, for strategies that partition space or a graph.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// Work at speed 1 for each PE, such that all PEs that get any finish at the same time, after their
/// background and pinned elements. The sum is the load of the elements that migrate; if these have
/// no load, equal shares of 1.
[[nodiscard]] std::vector<double> capacities(const Snapshot& snapshot);

/// The weight of each element relative to these capacities: its load; or n_pes divided by the number
/// of elements that migrate, if none of these has any.
[[nodiscard]] std::vector<double> weights(const Snapshot& snapshot);

}  // namespace tess::balance
