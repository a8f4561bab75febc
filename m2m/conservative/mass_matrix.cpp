#include "m2m/conservative/mass_matrix.hpp"

#include "m2m/interpolate/orientation.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {
namespace {

/// The row sums on the diagonal.
Symmetric4 lumped(const Symmetric4& m) {
  Symmetric4 out{};
  out[0] = (m[0] + m[1]) + (m[2] + m[3]);
  out[4] = (m[1] + m[4]) + (m[5] + m[6]);
  out[7] = (m[2] + m[5]) + (m[7] + m[8]);
  out[9] = (m[3] + m[6]) + (m[8] + m[9]);
  return out;
}

}  // namespace

MassMatrix::MassMatrix(MeshView mesh, std::span<const CellCoverage> coverage)
    : tets_(mesh.tets), n_points_(mesh.points.size()) {
  TESS_CHECK(coverage.empty() || coverage.size() == tets_.size(), "expected ", tets_.size(),
             " coverages, one per tetrahedron, got ", coverage.size());
  twentieths_.reserve(tets_.size());
  partial_.reserve(tets_.size());
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    const Corners c = corners_of(mesh.points, tets_[t]);
    const double volume = std::abs(orientation(c[0], c[1], c[2], c[3])) / 6;
    const double covered = coverage.empty() ? volume : coverage[t].volume;
    twentieths_.push_back(volume / 20);
    if (!(covered > no_coverage * volume)) {
      partial_.push_back(none);
    } else if (covered >= (1 - full_coverage) * volume) {
      partial_.push_back(whole);
    } else {
      partial_.push_back(static_cast<std::int32_t>(cut_.size()));
      cut_.push_back(covered >= consistent_coverage * volume ? coverage[t].mass
                                                             : lumped(coverage[t].mass));
    }
  }
}

Matrix4 MassMatrix::element(std::size_t tet) const {
  Matrix4 m;
  const std::int32_t place = partial_[tet];
  if (place == whole) {
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b) m[a][b] = twentieths_[tet] * (a == b ? 2 : 1);
    return m;
  }
  const Symmetric4& cut = cut_[static_cast<std::size_t>(place)];
  std::size_t k = 0;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a; b < 4; ++b) m[a][b] = m[b][a] = cut[k++];
  return m;
}

void MassMatrix::multiply_add(std::span<const double> x, std::size_t n_components,
                              std::span<double> y) const {
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    if (partial_[t] == none) continue;
    std::array<std::size_t, 4> row;
    for (std::size_t a = 0; a < 4; ++a)
      row[a] = static_cast<std::size_t>(tets_[t][a]) * n_components;
    if (partial_[t] == whole) {
      for (std::size_t c = 0; c < n_components; ++c) {
        const double sum = (x[row[0] + c] + x[row[1] + c]) + (x[row[2] + c] + x[row[3] + c]);
        for (std::size_t a = 0; a < 4; ++a) y[row[a] + c] += twentieths_[t] * (x[row[a] + c] + sum);
      }
      continue;
    }
    const Matrix4 m = element(t);
    for (std::size_t c = 0; c < n_components; ++c)
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b) y[row[a] + c] += m[a][b] * x[row[b] + c];
  }
}

void MassMatrix::add_diagonals(std::span<double> diagonal, std::span<double> lumped) const {
  for_each_element([&](const Tet& tet, const Matrix4& m) {
    for (std::size_t a = 0; a < 4; ++a) {
      const auto v = static_cast<std::size_t>(tet[a]);
      diagonal[v] += m[a][a];
      lumped[v] += (m[a][0] + m[a][1]) + (m[a][2] + m[a][3]);
    }
  });
}

std::vector<double> covered_fractions(std::span<const double> covered,
                                      std::span<const double> whole) {
  TESS_CHECK(covered.size() == whole.size(), "expected ", whole.size(), " masses, got ",
             covered.size());
  std::vector<double> fractions(whole.size(), 0.0);
  for (std::size_t v = 0; v < whole.size(); ++v)
    if (whole[v] > 0) fractions[v] = std::clamp(covered[v] / whole[v], 0.0, 1.0);
  return fractions;
}

}  // namespace tess::m2m
