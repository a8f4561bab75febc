// Writes a checkpoint. All steps are led by the main coroutine on PE 0:
//
//     quiet     nothing is under way on any PE, and periodic timers are frozen
//     census    nothing waits but the main coroutine, and every collection can be saved
//     save      each PE writes its elements into a file of its own
//     manifest  PE 0 writes "main" and the manifest, and removes older checkpoints
#pragma once

#include "runtime/checkpoint_options.hpp"
#include "runtime/task.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tess::detail {

/// `state` is the main coroutine's, of a type with this name.
[[nodiscard]] Task write_checkpoint(std::string folder, std::string state_type,
                                    std::vector<std::byte> state, CheckpointOptions options);

/// Ends with an error unless the main coroutine calls `what`.
void require_main(const std::string& what);

}  // namespace tess::detail
