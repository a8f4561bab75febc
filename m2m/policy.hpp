// The value of a target vertex that lies outside the source mesh. Its status is `outside` under
// every policy, and the report counts it.
#pragma once

#include "m2m/status.hpp"

#include <span>
#include <string>
#include <variant>

namespace tess::m2m {

/// The vertex keeps the value that it had before the transfer.
struct Keep {};
/// Every component gets the given value.
struct UseValue {
  double value = 0;
};
/// The vertex gets the value of the nearest source vertex. Ties go to the lowest global id.
struct Nearest {};

using OutsidePolicy = std::variant<Keep, UseValue, Nearest>;

/// "keep", "value:0.5", "value:nan" or "nearest". Throws Error (bad_argument) for any other text.
[[nodiscard]] OutsidePolicy parse_policy(const std::string& text);

/// Writes the value of a UseValue to what is outside; other policies change nothing. `values`: a
/// row per status.
void fill_outside(const OutsidePolicy& policy, std::span<const Status> status,
                  std::span<double> values);

}  // namespace tess::m2m
