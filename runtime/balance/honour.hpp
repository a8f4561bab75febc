// From the placement that a strategy wants to one that may be: elements that do not migrate stay,
// and no PE is filled above its memory limit. For strategies that decide without looking at either,
// among them the user's own.
#pragma once

#include "runtime/balance/snapshot.hpp"

namespace tess::balance {

/// `wanted`, except that what may not move, or finds no room, stays where it is: only that element.
/// Moves are tried until none finds room, so that elements may change places through free room.
/// Throws Error where `wanted` has not one PE of the snapshot for each element.
[[nodiscard]] Assignment honour(const Snapshot& snapshot, const Assignment& wanted);

}  // namespace tess::balance
