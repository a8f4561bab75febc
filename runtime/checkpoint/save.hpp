// Writes a checkpoint. All steps are led by the main coroutine on PE 0:
//
//     quiet     nothing is under way on any PE, and periodic timers are frozen
//     census    nothing waits but the main coroutine, and every collection can be saved
//     save      each PE writes its elements into a file of its own
//     copy      with buddy copies: each PE reads its file, and its buddy writes the copy
//     manifest  the first PE of each host (hosts.hpp) writes "main", then, once all have, the manifest,
//               and removes older checkpoints
//
// So a checkpoint that has a manifest on any host is complete on all.
#pragma once

#include "runtime/checkpoint_options.hpp"
#include "runtime/task.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace tess::detail {

struct Listing;

/// `pack` packs the state of the main coroutine, of a type with this name; it is called once nothing
/// is under way.
[[nodiscard]] Task write_checkpoint(std::string folder, std::string state_type,
                                    std::function<std::vector<std::byte>()> pack,
                                    CheckpointOptions options, std::string note);

/// A number for Runtime::lineage().
[[nodiscard]] std::uint64_t new_run();

/// Lists the checkpoints in a folder as all processes see it.
[[nodiscard]] TaskOf<Listing> list_all(std::string folder);

/// Ends with an error unless the main coroutine calls `what`.
void require_main(const std::string& what);

}  // namespace tess::detail
