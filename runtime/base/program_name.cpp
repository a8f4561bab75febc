#include "runtime/base/program_name.hpp"

#include <cerrno>

namespace tess::detail {

std::string error_heading() {
#if defined(__GLIBC__)
  return std::string(program_invocation_short_name) + ": error: ";
#else
  return "error: ";
#endif
}

}  // namespace tess::detail
