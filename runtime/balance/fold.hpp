// Maps a snapshot to another number of PEs, so that a measurement on 4 can be tried on 64 or on 2.
//
//     block    PE p of n goes to p·m / n: neighbours stay together        0 1 2 3 -> 0 0 1 1
//     modulo   PE p of n goes to p mod m: neighbours are dealt out        0 1 2 3 -> 0 1 0 1
//
// Elements keep their order, loads, messages and whether they may migrate.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <string_view>

namespace tess::balance {

enum class Fold : std::uint8_t { block, modulo };

/// The fold of this name: block, modulo. Throws Error that lists the names for any other.
[[nodiscard]] Fold parse_fold(std::string_view name);

/// The snapshot on `n_pes` PEs, at least 1. For its own number of PEs it is returned unchanged.
/// Otherwise all PEs have speed 1 and neither background nor memory limits, since these are
/// unknown, and each needs as much working memory as the PE that needed most.
[[nodiscard]] Snapshot fold(Snapshot snapshot, std::size_t n_pes, Fold how);

}  // namespace tess::balance
