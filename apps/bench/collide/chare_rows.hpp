// The rows of colliders: the same scenes on chares, beside the serial face in the same turns.
#pragma once

#include "apps/bench/collide/output.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bench {

/// Name and meaning of each row of a case; none for most cases. Rows of two PEs need two cores.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> chare_row_texts(
    const std::string& of_case);

/// Throws tess::Error if a collider finds another number of pairs than the serial face. Starts
/// threads, which need more than one core: call it last, and not on the one core of other rows.
void chare_rows(Output& output);

}  // namespace bench
