// Turns the placement that a strategy proposes into a permitted one: elements that do not migrate
// stay, and no PE is filled above its memory limit. For strategies that ignore these rules, such as
// the user's own.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <string_view>

namespace tess::balance {

/// `wanted`, except that each element that may not move, or for which there is no room, stays.
/// Moves are tried until none fits, so that elements may change places through free memory. Throws
/// Error, with the name of the strategy, unless `wanted` has one PE of the snapshot for each
/// element.
[[nodiscard]] Assignment honour(const Snapshot& snapshot, const Assignment& wanted,
                                std::string_view strategy = "built in");

}  // namespace tess::balance
