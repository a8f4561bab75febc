// Restores the latest good checkpoint of a folder. All steps are led by the main coroutine on PE 0:
//
//     choose    the files of the latest checkpoint are read and compared with its manifest; if one
//               is damaged, that is reported, and its copy on any host is tried, then the
//               checkpoint before
//     plan      the program has all the classes, and groups fit the number of PEs
//     create    every PE makes the collections, empty, with the ids that they had
//     restore   the PEs read the files and send each element to its home
//     finish    ids continue after those that were given; ended collections have ended
#pragma once

#include "runtime/core/error.hpp"
#include "runtime/task.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tess::detail {

/// The folder of the latest checkpoint that was finished; empty if there is none.
[[nodiscard]] std::string latest_checkpoint(const std::string& folder);

/// The bytes of the main coroutine's state.
[[nodiscard]] TaskOf<std::vector<std::byte>> read_checkpoint(std::string folder,
                                                             std::string state_type);

/// Throws the error of a state object that was read, with the remedy.
[[noreturn]] void refuse_state(std::string_view state_type, const Error& error);

}  // namespace tess::detail
