// The tables and the picture of a scaling study.
#pragma once

#include "apps/collide_scaling/case.hpp"

#include <string>
#include <vector>

namespace collide_scaling {

/// Of a table in Markdown; rows are printed as soon as they are known.
[[nodiscard]] std::string head(bool is_strong);
/// `first`: the row that the efficiency refers to.
[[nodiscard]] std::string line(const Row& row, const Row& first);

/// The efficiency of the last row, and how it was got.
[[nodiscard]] std::string conclusion(const std::vector<Row>& rows, bool is_checked);

/// PREFIX.svg with the efficiency against PEs, and PREFIX.csv beside it.
void draw(const std::string& prefix, const std::vector<Row>& rows);

}  // namespace collide_scaling
