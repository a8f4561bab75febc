// Bad input, which the user can correct. It is thrown before anything is sent; programs print
// what() in one line and exit with 2. A bug is not an Error: see check.hpp.
#pragma once

#include "runtime/core/text.hpp"

#include <stdexcept>
#include <string>

namespace tess {

/// What kind of input was refused.
enum class ErrorCode { bad_argument, bad_file, bad_mesh, bad_value, out_of_range, environment };

/// Input that cannot be used. The message names the value, its place, and the remedy.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

/// Throws an Error whose message is the parts, one after the other.
template <class... Parts>
[[noreturn, gnu::cold]] void fail(ErrorCode code, const Parts&... parts) {
  throw Error(code, failure_text(parts...));
}

}  // namespace tess
