// Where an axis is labelled.
#pragma once

#include <cmath>
#include <initializer_list>

namespace kit {

/// 1, 2 or 5 times a power of ten, such that 4 to 10 of them make up `span`, which is above 0.
[[nodiscard]] inline double tick_step(double span) {
  const double power = std::pow(10, std::floor(std::log10(span / 4)));
  for (const double factor : {5.0, 2.0})
    if (span / (factor * power) >= 4) return factor * power;
  return power;
}

}  // namespace kit
