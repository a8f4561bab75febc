#include "apps/m2m_transfer/input/formulas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace m2m_transfer {

std::optional<double> largest_second_derivative(const std::string& field, const Aabb& domain) {
  double side = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    side = std::max(side, domain.hi[axis] - domain.lo[axis]);
  if (!(side > 0)) side = 1;
  if (field == "linear") return 0;
  // exp(-|r|²) has its largest second derivative, -2, at r = 0; r = 4/side times the position.
  if (field == "gaussian") return 2 * 16 / (side * side);
  // The product of three sines is the mean of four plane waves with the wave vectors k (1, ±1, ±1).
  // Along a unit vector v their squares sum to 4 k² |v|²; the corners of a cube of extrema reach
  // k².
  if (field == "sin") return std::pow(2 * std::numbers::pi / side, 2);
  return std::nullopt;
}

double typical_edge(const MeshSurvey& mesh) {
  return std::cbrt(6 * mesh.volume / static_cast<double>(mesh.n_tets));
}

}  // namespace m2m_transfer
