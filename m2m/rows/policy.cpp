#include "m2m/policy.hpp"

#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {

OutsidePolicy parse_policy(const std::string& text) {
  if (text == "keep") return Keep{};
  if (text == "nearest") return Nearest{};
  if (text.starts_with("value:")) {
    const auto value = parse_number<double>(std::string_view(text).substr(6));
    if (value && !std::isinf(*value)) return UseValue{*value};
  }
  fail(ErrorCode::bad_argument, "policy '", text,
       "' is unknown; choose keep, nearest or value:NUMBER",
       did_you_mean(text, "keep nearest value:NUMBER"));
}

void fill_outside(const OutsidePolicy& policy, std::span<const Status> status,
                  std::span<double> values) {
  const auto* given = std::get_if<UseValue>(&policy);
  if (given == nullptr || status.empty()) return;
  const std::size_t n_components = values.size() / status.size();
  for (std::size_t v = 0; v < status.size(); ++v)
    if (status[v] == Status::outside)
      std::fill_n(values.data() + v * n_components, n_components, given->value);
}

}  // namespace tess::m2m
