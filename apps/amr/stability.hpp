// Cases at the edge of what amr computes. Each compares with what must hold there: an exact shift,
// a translated or mirrored run, a uniform tree, bounds; and in each the mass stays the same.
#pragma once

#include "apps/kit/cases.hpp"
#include "runtime/task.hpp"

namespace amr {

/// `corrected` as in Problem: without it the cases with two levels fail.
tess::Task run_stability(bool corrected, kit::Cases<>& cases);

}  // namespace amr
