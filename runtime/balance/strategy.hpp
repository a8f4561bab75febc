// Strategies by name. A strategy is a pure function from a snapshot to an assignment: equal
// snapshots and seeds give equal results. Elements that do not migrate stay; no move takes a PE
// above its memory limit (memory.hpp: a block that elements share counts once per PE), and an
// element for which there is no room stays. An element of unknown load also stays; built-in
// strategies count it as the mean of the others. Each strategy has a file in strategies/.
#pragma once

#include "runtime/balance/snapshot.hpp"
#include "runtime/core/hash.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace tess::balance {

/// A strategy, built in or defined by the user.
using Strategy = std::function<Assignment(const Snapshot&)>;

/// Tells snapshots of different versions of this code apart. Where the meaning of a member changes
/// and no size does, the first number grows.
inline constexpr std::uint64_t snapshot_version = [] {
  std::uint64_t hash = 1;
  for (const std::uint64_t size :
       {sizeof(Snapshot), sizeof(Elements), sizeof(Pes), sizeof(Edge), sizeof(SharedBlock),
        sizeof(Load), sizeof(ElementKey), sizeof(Strategy), sizeof(std::string)})
    hash = mix(hash ^ size);
  return hash;
}();

/// Adds the user's own strategy under a name, which --balance, make_strategy() and BalanceOptions
/// accept from then on. It may return any PE for elements that may not move, or have no room: they
/// stay. It gets loads as they are, also unknown ones (load.hpp). Called before the run, on every
/// process. Throws Error for a name that is taken or has other characters than letters, digits, '_'
/// and '-', for an empty function, and for one that was compiled against another version.
void register_strategy(const std::string& name, Strategy strategy,
                       std::uint64_t version = snapshot_version);

/// Loads a shared library with the user's strategies, for the rest of the process. It exports
/// extern "C" void tess_register_strategies(), which calls register_strategy(); it is compiled with
/// the headers of this version and links nothing of Tessera: the program exports what it calls
/// (ENABLE_EXPORTS). Throws Error, with the file, if that is not so or nothing is registered.
void load_strategy_library(const std::string& path);

/// The names that make_strategy accepts, in the order of tables; users' own stand last.
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
/// `name` is for errors.
[[nodiscard]] Strategy make_strategy(Strategy users, std::string name = "own");

}  // namespace tess::balance
