#include "m2m/field.hpp"

#include "m2m/fields/expression.hpp"
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

ErrorNorms error_norms(const TetMesh& mesh, std::span<const double> values,
                       std::span<const double> truth, const std::vector<bool>& counts) {
  TESS_CHECK(values.size() == mesh.n_points() && truth.size() == mesh.n_points() &&
                 (counts.empty() || counts.size() == mesh.n_points()),
             "expected ", mesh.n_points(), " values, one per vertex, got ", values.size(), " and ",
             truth.size());
  std::vector<double> mass(mesh.n_points(), 0.0);
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    const double quarter = std::abs(signed_volume(mesh, t)) / 4;
    for (const VertexId v : mesh.tets[t]) mass[static_cast<std::size_t>(v)] += quarter;
  }
  ErrorNorms norms;
  double weighted = 0, plain = 0, reference = 0;
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!counts.empty() && !counts[v]) continue;
    const double error = std::abs(values[v] - truth[v]);
    weighted += mass[v] * error * error;
    reference += mass[v] * truth[v] * truth[v];
    plain += error * error;
    // A NaN counts as the largest error.
    if (norms.n_vertices++ == 0 || error > norms.linf ||
        (std::isnan(error) && !std::isnan(norms.linf))) {
      norms.linf = error;
      norms.worst = static_cast<GlobalId>(v);
    }
  }
  if (norms.n_vertices == 0) {
    norms.l2 = norms.l2_relative = norms.rms = norms.linf =
        std::numeric_limits<double>::quiet_NaN();
    return norms;
  }
  norms.l2 = std::sqrt(weighted);
  norms.l2_relative = reference > 0 ? norms.l2 / std::sqrt(reference) : norms.l2;
  norms.rms = std::sqrt(plain / static_cast<double>(norms.n_vertices));
  return norms;
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
