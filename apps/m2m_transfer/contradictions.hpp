// Options that do not work together. None of them is passed over in silence.
#pragma once

#include "apps/kit/file_names.hpp"
#include "apps/m2m_transfer/driver.hpp"

#include <string>

namespace m2m_transfer {

/// What a run does: exactly one of these.
enum class Mode : std::uint8_t { transfer, files, study, round_trips, stability };

/// Throws Error (bad_argument) with the first option that the mode does not use, with the value
/// given. Without a command line (DriverOptions::line) only values are compared.
void refuse_contradictions(const DriverOptions& options, Mode mode);

/// The files that the options name; `trace` is that of the runtime's option. Throws Error
/// (bad_argument) with the first output whose path is that of an input or of another output.
[[nodiscard]] kit::FileNames file_names(const DriverOptions& options, const std::string& trace);

}  // namespace m2m_transfer
