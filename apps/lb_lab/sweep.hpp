// All runs that the settings ask for, one after the other on one machine, each compared with the
// serial answer.
#pragma once

#include "apps/lb_lab/run/sweep_rows.hpp"
#include "runtime/runtime.hpp"

namespace lb_lab {

/// Runs on PE 0, fills the sweep. `steps_a_second`: of walk().
tess::Task run_all(Sweep& sweep, double steps_a_second);

}  // namespace lb_lab
