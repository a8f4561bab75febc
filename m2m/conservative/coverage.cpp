#include "m2m/conservative/coverage.hpp"

#include "m2m/interpolate/orientation.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {

void CellCoverage::add(const PairMoments& moments) {
  volume += moments.volume;
  std::size_t k = 0;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a; b < 4; ++b) mass[k++] += moments.target[a][b];
}

CellCoverage& CellCoverage::operator+=(const CellCoverage& other) {
  volume += other.volume;
  for (std::size_t k = 0; k < mass.size(); ++k) mass[k] += other.mass[k];
  return *this;
}

std::vector<double> covered_fractions(std::span<const Point> points, std::span<const Tet> tets,
                                      std::span<const CellCoverage> coverage) {
  TESS_CHECK(coverage.size() == tets.size(), "expected ", tets.size(),
             " coverages, one per tetrahedron, got ", coverage.size());
  std::vector<double> fractions(tets.size(), 0.0);
  for (std::size_t t = 0; t < tets.size(); ++t) {
    const Corners c = corners_of(points, tets[t]);
    const double volume = std::abs(orientation(c[0], c[1], c[2], c[3])) / 6;
    if (volume > 0) fractions[t] = std::clamp(coverage[t].volume / volume, 0.0, 1.0);
  }
  return fractions;
}

}  // namespace tess::m2m
