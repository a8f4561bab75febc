// The rows of boxes: for each case the time of each method in turns, their pairs compared with each
// other, and our memory.
#pragma once

#include "apps/bench/collide/output.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bench {

/// Name and meaning of each row, in the order in which they come, under the name of a case.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> box_row_texts(
    const std::string& of_case);

/// Throws tess::Error if a method finds a wrong set of pairs. Forks: call it before a library has
/// started threads.
void box_rows(Output& output);

/// Our time per object from 2^10 to 2^22 objects, of three cases.
void growth_rows(Output& output);
inline constexpr const char* growth_cases[] = {"wave_self", "boxes", "disparity"};

}  // namespace bench
