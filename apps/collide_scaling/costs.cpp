#include "apps/collide_scaling/costs.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace collide_scaling {

std::string text_of(const SimulatedCosts& costs) {
  std::string out;
  for (const PartOfStep& part : parts)
    out += fmt::format("{}{}={}ns", out.empty() ? "" : ",", part.name, costs.*part.cost);
  return out;
}

SimulatedCosts parse_costs(const std::vector<std::string>& texts) {
  SimulatedCosts costs;
  for (const std::string_view text : texts) {
    const std::size_t end = text.find('=');
    const auto part = std::ranges::find(parts, text.substr(0, end), &PartOfStep::name);
    std::string_view rest = end == text.npos ? "" : text.substr(end + 1);
    const auto value = tess::take_number<double>(rest);
    if (part == parts.end() || !value || rest != "ns" || !(*value >= 0 && *value <= 1e9))
      tess::fail(tess::ErrorCode::bad_argument, "--costs ", text,
                 ": give parts as in gridding=9.5ns,pair=20ns, from 0 to 1e9ns; they are gridding, "
                 "search, pair, reply, copy and record");
    costs.*part->cost = *value;
  }
  return costs;
}

/// One cost after the other is set to its best value for the present others, which ends at the best
/// of all costs since the squares are convex.
SimulatedCosts fitted_costs(std::span<const MeasuredStep> steps) {
  constexpr int n_rounds = 10'000;
  std::array<double, n_fitted> cost{};
  for (int round = 0; round < n_rounds; ++round)
    for (std::size_t k = 0; k < n_fitted; ++k) {
      double product = 0, square = 0;
      for (const MeasuredStep& step : steps) {
        double rest = 1;  // of the measured time, which the other parts leave
        for (std::size_t other = 0; other < n_fitted; ++other)
          if (other != k) rest -= cost[other] * step.n_items[other] / step.nanoseconds;
        const double own = step.n_items[k] / step.nanoseconds;
        product += rest * own;
        square += own * own;
      }
      cost[k] = square > 0 ? std::max(0.0, product / square) : 0;
    }
  SimulatedCosts out;
  for (std::size_t k = 0; k < n_fitted; ++k) out.*parts[k].cost = cost[k];
  return out;
}

}  // namespace collide_scaling
