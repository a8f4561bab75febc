// Prints the stability report of the particle rules (--stability).
#pragma once

namespace particles {

/// Runs the report and, on the process that `speaks`, prints it. False if a row fails.
[[nodiscard]] bool print_stability(bool speaks);

}  // namespace particles
