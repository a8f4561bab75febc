// bench --calibrate FILE: finds the parameters with which the simulated machine takes as long as
// this one. A run on two PEs of a process finds those within a process, a run on two processes
// those between them; each keeps the lines of the other in the file.
#pragma once

#include "apps/bench/bench.hpp"

#include <string>

namespace bench {

/// Throws Error unless this machine is real and has two PEs, and the file can be extended.
void require_calibration(const std::string& path, const tess::Machine& machine);

/// Measures, fits, writes the file and prints what was found. Returns the exit code.
[[nodiscard]] int calibrate(const Bench& bench, const std::string& path);

}  // namespace bench
