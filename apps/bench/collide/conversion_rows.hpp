// The rows of the conversion table: time per coordinate, and shares of wrong indices.
#pragma once

#include "apps/bench/collide/output.hpp"

#include <string>
#include <utility>
#include <vector>

namespace bench {

/// Name and meaning of each row.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> conversion_row_texts();

void conversion_rows(Output& output);

}  // namespace bench
