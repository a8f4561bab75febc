// The command line of m2m_transfer, which m2m_stability reads as well: it refuses with their names
// the options that it does not use.
#pragma once

#include "apps/m2m_transfer/driver.hpp"

namespace m2m_transfer {

/// Adds all options to `line`, and sets `options` from the arguments. `line` must outlive `options`.
/// Returns false if the help was printed. Throws Error (bad_argument) for what cannot be read.
[[nodiscard]] bool read_options(tess::CommandLine& line, DriverOptions& options, int argc,
                                char** argv);

}  // namespace m2m_transfer
