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
  // Along a unit vector v their squares sum to 4 k² |v|²; the corners of a cube of extrema reach k².
  if (field == "sin") return std::pow(2 * std::numbers::pi / side, 2);
  return std::nullopt;
}

double longest_edge(const TetMesh& mesh) {
  double longest = 0;
  for (const Tet& tet : mesh.tets)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Point& p = mesh.points[static_cast<std::size_t>(tet[i])];
        const Point& q = mesh.points[static_cast<std::size_t>(tet[j])];
        longest = std::max(longest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
      }
  return longest;
}

double typical_edge(const TetMesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) volume += std::abs(signed_volume(mesh, t));
  return std::cbrt(6 * volume / static_cast<double>(mesh.n_tets()));
}

}  // namespace m2m_transfer
