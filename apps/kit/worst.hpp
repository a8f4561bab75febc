// The worst of several values: NaN is worse than any. (std::max and std::min pass over it.)
#pragma once

#include <cmath>

namespace kit {

/// The greatest so far, or NaN.
inline void worsen(double& worst, double value) {
  if (value > worst || std::isnan(value)) worst = value;
}
/// The least so far, or NaN.
inline void lower(double& least, double value) {
  if (value < least || std::isnan(value)) least = value;
}

}  // namespace kit
