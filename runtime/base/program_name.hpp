// The name of the running program, for its lines of error.
#pragma once

#include <string>

namespace tess::detail {

/// "stencil: "; empty where the system does not say.
[[nodiscard]] std::string error_prefix();

}  // namespace tess::detail
