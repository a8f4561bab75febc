#include "m2m/field.hpp"

#include "m2m/mesh/fields/expression.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace tess::m2m {

Formula make_formula(const std::string& name, const Aabb& domain) {
  double side = 0;
  Point centre{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    side = std::max(side, domain.hi[axis] - domain.lo[axis]);
    centre[axis] = domain.lo[axis] + 0.5 * (domain.hi[axis] - domain.lo[axis]);
  }
  if (!(side > 0)) side = 1;
  if (name == "gaussian") {
    return [centre, scale = 4 / side](const Point& p) {
      double squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        squared += std::pow((p[axis] - centre[axis]) * scale, 2);
      return std::exp(-squared);
    };
  }
  if (name == "linear") {
    return [](const Point& p) { return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2]; };
  }
  if (name == "sin") {
    return [low = domain.lo, k = 2 * std::numbers::pi / side](const Point& p) {
      return std::sin(k * (p[0] - low[0])) * std::sin(k * (p[1] - low[1])) *
             std::sin(k * (p[2] - low[2]));
    };
  }
  return [expression = Expression(name)](const Point& p) { return expression(p); };
}

std::string not_finite_text(const std::string& field, double value, GlobalId vertex,
                            const std::string& mesh, const Point& at) {
  return text("field ", field, " is ", value, " at vertex ", vertex, " of ", mesh, " (", at[0],
              ", ", at[1], ", ", at[2], "); choose a formula that is finite on both meshes");
}

Field sample(const TetMesh& mesh, const std::string& name, const Formula& formula) {
  Field field{name, 1, std::vector<double>(mesh.n_points())};
  for (std::size_t v = 0; v < mesh.n_points(); ++v) {
    field.values[v] = formula(mesh.points[v]);
    if (!std::isfinite(field.values[v]))
      throw Error(ErrorCode::bad_value,
                  not_finite_text(name, field.values[v], static_cast<GlobalId>(v), mesh.name,
                                  mesh.points[v]));
  }
  return field;
}

std::uint64_t result_hash(std::span<const double> values, std::uint64_t start) noexcept {
  std::uint64_t hash = start;
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    for (unsigned byte = 0; byte < 8; ++byte)
      hash = (hash ^ (bits >> (8 * byte) & 0xffU)) * 0x100000001b3U;
  }
  return hash;
}

}  // namespace tess::m2m
