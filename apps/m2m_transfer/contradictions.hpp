// Options that do not work together. None of them is passed over in silence.
#pragma once

#include "apps/m2m_transfer/driver.hpp"

namespace m2m_transfer {

/// What a run does: exactly one of these.
enum class Mode : std::uint8_t { transfer, files, study, round_trips, stability };

/// Throws Error (bad_argument) with the first option that the mode does not use, with the value
/// given.
void refuse_contradictions(const DriverOptions& options, Mode mode);

/// Throws Error (bad_argument) with the first output whose path is that of an input or of another
/// output.
void refuse_equal_paths(const DriverOptions& options);

}  // namespace m2m_transfer
