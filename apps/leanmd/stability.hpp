// The stability report: stiff and extreme simulations. Those that can run must agree with all
// pairs, keep their energy, and return to their start when the velocities are reversed; the others
// must be refused with the right reason.
#pragma once

#include "apps/kit/cases.hpp"
#include "runtime/task.hpp"

namespace leanmd {

/// On PE 0. Takes about a second. `parameter` is the number of atoms, `met` the energy drift per
/// atom of a case that runs.
tess::Task stability_report(kit::Cases<>& report);

}  // namespace leanmd
