// Strategies by name. A strategy is a pure function from a snapshot to an assignment: equal
// snapshots and seeds give equal results. Elements that do not migrate stay; no move takes a PE
// above its memory limit (memory.hpp: a block that elements share counts once per PE), and an
// element for which there is no room stays. An element of unknown load also stays; built-in
// strategies count it as the mean of the others. Each strategy has a file in strategies/.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tess::balance {

/// A strategy, built in or defined by the user.
using Strategy = std::function<Assignment(const Snapshot&)>;

/// The names that make_strategy accepts, in the order of tables.
[[nodiscard]] const std::vector<std::string>& strategy_names();

/// The strategy of this name. Throws Error that lists the names for any other.
[[nodiscard]] Strategy make_strategy(std::string_view name, std::uint64_t seed);

/// True for a strategy that places elements by their positions.
[[nodiscard]] bool needs_positions(std::string_view name);

/// True for a strategy that the PEs of a run carry out among themselves, without a list of all
/// elements. It uses the loads of the last phase.
[[nodiscard]] bool is_distributed(std::string_view name);

/// Why the strategy of this name cannot serve a snapshot, as a sentence; empty if it can.
[[nodiscard]] std::string obstacle(std::string_view name, const Snapshot& snapshot);

/// Wraps the user's function: its assignment is followed where elements may move and there is room.
/// The function gets the snapshot as it is: an unknown load is unknown there (load.hpp).
/// The result throws Error unless the function gives one PE of the snapshot per element.
[[nodiscard]] Strategy make_strategy(Strategy users);

}  // namespace tess::balance
