#include "apps/bench/collide/output.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace bench {

bool Output::wants(std::string_view of, std::string_view row) const {
  return options_.names.empty() ||
         std::any_of(options_.names.begin(), options_.names.end(),
                     [&](const std::string& name) { return name == of || name == row; });
}

bool Output::wants_any(std::string_view of) const {
  const std::string prefix = fmt::format("{}_", of);
  return wants(of, of) ||
         std::any_of(options_.names.begin(), options_.names.end(),
                     [&](const std::string& name) { return name.starts_with(prefix); });
}

void Output::row(std::string_view of, const std::string& name, const Samples& samples,
                 std::string_view unit, double limit, std::optional<Origin> origin) {
  if (wants(of, name)) report_.row(name, samples, unit, limit, std::move(origin));
}

void Output::row(std::string_view of, const std::string& name, double value,
                 std::string_view unit) {
  Samples one;
  one.add(value);
  row(of, name, one, unit);
}

}  // namespace bench
