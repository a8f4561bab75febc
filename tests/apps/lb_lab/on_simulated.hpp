// Runs of the laboratory on a simulated machine, inside a test.
#pragma once

#include "apps/lb_lab/sweep.hpp"

#include <string>

namespace lb_lab {

/// All runs that the settings ask for, on "--sim OPTIONS".
[[nodiscard]] Sweep sweep_on(const std::string& options, Settings settings);

}  // namespace lb_lab
