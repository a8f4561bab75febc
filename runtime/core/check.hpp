// Checks for bugs and misuse, on in every build. TESS_CHECK prints the condition, its place and
// what was expected, adds what the runtime does on this thread (PE, array, index, entry, epoch),
// and ends the job.
#pragma once

#include "runtime/core/error.hpp"

namespace tess {

/// Prints the failure with the context of this thread and ends the job with exit code 1.
[[noreturn]] void check_failed(const char* condition, const char* file, int line,
                               const std::string& message);

/// Describes the context of this thread. The scheduler installs it; it may be null.
using CheckContext = std::string (*)();
void set_check_context(CheckContext describe) noexcept;

/// Ends the job after the text has been printed. A machine of many processes installs its abort.
/// Returns the former one.
using CheckAbort = void (*)();
CheckAbort set_check_abort(CheckAbort end) noexcept;

}  // namespace tess

#define TESS_CHECK(condition, ...)                                                             \
  do {                                                                                         \
    if (!(condition)) [[unlikely]]                                                             \
      ::tess::check_failed(#condition, __FILE__, __LINE__, ::tess::failure_text(__VA_ARGS__)); \
  } while (false)
