#include "runtime/base/program_name.hpp"

#include <cerrno>

namespace tess::detail {

std::string error_prefix() {
#if defined(__GLIBC__)
  return std::string(program_invocation_short_name) + ": ";
#else
  return {};
#endif
}

}  // namespace tess::detail
