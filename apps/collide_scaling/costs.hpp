// What the parts of a collision cost: as text, and fitted to measured steps.
#pragma once

#include "collide/collider.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace collide_scaling {

using tess::collide::SimulatedCosts;

struct PartOfStep {
  std::string_view name;
  double SimulatedCosts::*cost;
};
/// One PE has items of the first `n_fitted`.
inline constexpr std::array<PartOfStep, 6> parts{{{"gridding", &SimulatedCosts::gridding},
                                                  {"search", &SimulatedCosts::search},
                                                  {"pair", &SimulatedCosts::pair},
                                                  {"reply", &SimulatedCosts::reply},
                                                  {"copy", &SimulatedCosts::copy},
                                                  {"record", &SimulatedCosts::record}}};
inline constexpr std::size_t n_fitted = 4;

/// "gridding=9.31ns,search=20ns,…" for all parts.
[[nodiscard]] std::string text_of(const SimulatedCosts& costs);
/// A part that no text names costs nothing. Throws Error (bad_argument) with the text that is wrong.
[[nodiscard]] SimulatedCosts parse_costs(const std::vector<std::string>& texts);

/// A step of one PE: the items of each part, and the nanoseconds that they took.
struct MeasuredStep {
  std::array<double, n_fitted> n_items{};
  double nanoseconds = 0;
};
/// The costs per item, none of them negative, with the least squares of relative errors.
[[nodiscard]] SimulatedCosts fitted_costs(std::span<const MeasuredStep> steps);

}  // namespace collide_scaling
