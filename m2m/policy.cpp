#include "m2m/policy.hpp"

#include "runtime/core/error.hpp"

#include <charconv>
#include <cmath>

namespace tess::m2m {

OutsidePolicy parse_policy(const std::string& text) {
  if (text == "keep") return Keep{};
  if (text == "nearest") return Nearest{};
  if (text.starts_with("value:")) {
    UseValue policy;
    const char* const end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data() + 6, end, policy.value);
    if (error == std::errc() && last == end && std::isfinite(policy.value)) return policy;
  }
  fail(ErrorCode::bad_argument, "policy '", text,
       "' is unknown; choose keep, nearest or value:NUMBER");
}

}  // namespace tess::m2m
