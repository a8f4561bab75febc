// The name of the running program, for its lines of error.
#pragma once

#include <string>

namespace tess::detail {

/// "stencil: error: "; "error: " where the system does not say the name.
[[nodiscard]] std::string error_heading();

}  // namespace tess::detail
