// The power law of some points: the order of an error.
#pragma once

#include "apps/kit/output/chart.hpp"

#include <optional>
#include <vector>

namespace kit {

/// The exponent p of the best fit y = c x^p (least squares of the logarithms), over the points that
/// are finite and positive. Empty if these have fewer than two different x.
[[nodiscard]] std::optional<double> fitted_power(const std::vector<Point>& points);

}  // namespace kit
