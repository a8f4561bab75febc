// The norms of an error in one loop, for tests of what parts add up (m2m/field_norms.hpp).
#pragma once

#include "m2m/field.hpp"
#include "runtime/core/check.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tess::test {

/// `values`, `truth`: one number per vertex. `counts`: true for each vertex that is included; an
/// empty vector includes all vertices.
[[nodiscard]] inline m2m::ErrorNorms error_norms(const m2m::TetMesh& mesh,
                                                 std::span<const double> values,
                                                 std::span<const double> truth,
                                                 const std::vector<bool>& counts = {}) {
  TESS_CHECK(values.size() == mesh.n_points() && truth.size() == mesh.n_points() &&
                 (counts.empty() || counts.size() == mesh.n_points()),
             "expected ", mesh.n_points(), " values, one per vertex, got ", values.size(), " and ",
             truth.size());
  std::vector<double> mass(mesh.n_points(), 0.0);
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    const double quarter = std::abs(m2m::signed_volume(mesh, t)) / 4;
    for (const m2m::VertexId v : mesh.tets[t]) mass[static_cast<std::size_t>(v)] += quarter;
  }
  m2m::ErrorNorms norms;
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
      norms.worst = static_cast<m2m::GlobalId>(v);
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

}  // namespace tess::test
