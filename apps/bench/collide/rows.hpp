// The rows of bench_collide, with the name and the meaning of each: boxes by each method in turns,
// whose pairs are compared; our conversions of a coordinate; the same scenes on chares, beside the
// serial face in the same turns. Rows of pairs throw tess::Error for a wrong set of them.
#pragma once

#include "apps/bench/collide/output.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bench {

using RowTexts = std::vector<std::pair<std::string, std::string>>;

/// In the order in which they come, under the name of a case.
[[nodiscard]] RowTexts box_row_texts(const std::string& of_case);
/// Forks: call it before a library has started threads.
void box_rows(Output& output);

/// Our time per object from 2^10 to 2^22 objects, of three cases.
void growth_rows(Output& output);

/// Time per coordinate, and shares of wrong indices.
[[nodiscard]] RowTexts conversion_row_texts();
void conversion_rows(Output& output);

/// None for most cases. Rows of two PEs need two cores.
[[nodiscard]] RowTexts chare_row_texts(const std::string& of_case);
/// Starts threads, which need more than one core: call it last, and not on the one core of other
/// rows.
void chare_rows(Output& output);

}  // namespace bench
