// Strategies by name. A strategy is a pure function from a snapshot to an assignment: the same
// snapshot and seed give the same answer. Elements that do not migrate stay; no move takes a PE
// above its memory limit; an element that finds no room stays where it is, and so does one whose
// load is not known: it counts as the mean of the others. One file a strategy stands in
// strategies/.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tess::balance {

/// A strategy, ours or the user's.
using Strategy = std::function<Assignment(const Snapshot&)>;

/// What make_strategy takes, in the order of tables.
[[nodiscard]] const std::vector<std::string>& strategy_names();

/// The strategy of that name. Throws Error that lists the names for any other.
[[nodiscard]] Strategy make_strategy(std::string_view name, std::uint64_t seed);

/// The user's function made safe: what it wants is honoured where elements may move and find room.
/// The result throws Error where the function does not give one PE of the snapshot an element.
[[nodiscard]] Strategy make_strategy(Strategy users);

}  // namespace tess::balance
