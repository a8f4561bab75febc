// What fsi prints and writes of its runs, and its cases at the edge.
#pragma once

#include "apps/fsi/simulate.hpp"
#include "apps/kit/cases.hpp"
#include "apps/kit/rows.hpp"

#include <string>
#include <vector>

namespace fsi {

struct Row {
  Problem problem;
  Outcome outcome;
};

[[nodiscard]] const kit::Rows<Row>& report();
/// Error against run time: meshes and steps refined together.
[[nodiscard]] kit::Chart chart_of(const std::vector<Row>& rows);
/// What a run does, and what it leaves out.
[[nodiscard]] std::string explanation(const Settings& settings);
/// Empty if panel and fluid agreed in each step, and no force was lost between them.
[[nodiscard]] std::string fault(const Outcome& outcome);

/// Light panels in dense fluids, with Aitken's factors and without.
tess::Task run_stability(std::int32_t n_pieces, kit::Cases<>& cases);

}  // namespace fsi
