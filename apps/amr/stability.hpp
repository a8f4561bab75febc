// Cases at the edge of what amr computes. Each compares with what must hold there: an exact shift,
// a translated or mirrored run, a uniform tree, bounds; and in each the mass stays the same.
#pragma once

#include "apps/amr/problem.hpp"
#include "runtime/task.hpp"

#include <string>
#include <vector>

namespace amr {

struct StabilityRow {
  std::string name, expected, found;
  bool holds = false;
};

/// `corrected` as in Problem: without it the rows with two levels fail.
tess::Task run_stability(bool corrected, std::vector<StabilityRow>& rows,
                         void (*tell)(const StabilityRow&));

}  // namespace amr
