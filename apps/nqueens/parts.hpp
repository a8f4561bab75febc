// The search in parts, for checkpoints: the search below a board has no quiet moment, so a
// checkpoint is made between two searches. The parts are the boards with queens in the first three
// rows, from left to right; the search below some of them is one epoch. A checkpoint holds no
// chare, only how many parts are done and what they gave.
#pragma once

#include "apps/kit/checkpoints.hpp"
#include "apps/nqueens/search.hpp"

#include <cstdint>
#include <optional>

namespace nqueens {

/// As search(). After a restart n and `first` of the problem are those of the checkpoint, and a
/// grain that is not given is the default for that n. Throws tess::Error if it, or the number of
/// solutions that is expected, does not fit them.
tess::Task search_in_parts(Problem& problem, std::optional<std::int32_t> grain,
                           std::optional<std::uint64_t> expected, kit::Checkpoints& checkpoints,
                           Outcome& outcome);

}  // namespace nqueens
