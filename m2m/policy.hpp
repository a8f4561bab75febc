// What a target vertex outside the source mesh gets. Its status is `outside` whatever the policy,
// and it is counted.
#pragma once

#include <string>
#include <variant>

namespace tess::m2m {

/// The value it had before.
struct Keep {};
/// A given value, in every component.
struct UseValue {
  double value = 0;
};
/// The value of the nearest source vertex; of several as near, the one of lowest global id.
struct Nearest {};

using OutsidePolicy = std::variant<Keep, UseValue, Nearest>;

/// "keep", "value:0.5" or "nearest"; throws Error (bad_argument) otherwise.
[[nodiscard]] OutsidePolicy parse_policy(const std::string& text);

}  // namespace tess::m2m
