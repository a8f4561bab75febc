// The driver's part for fields and weights of files (file_fields.hpp): options in, reports out.
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/m2m_transfer/driver.hpp"

namespace m2m_transfer {

/// True if the options name a step, a file of weights, or a field of the source file.
[[nodiscard]] bool moves_file_fields(const DriverOptions& options);

/// Moves them, prints the table, and writes what --out, --weights and --json name.
Task move_file_fields(const DriverOptions& options, kit::Progress& progress);

}  // namespace m2m_transfer
