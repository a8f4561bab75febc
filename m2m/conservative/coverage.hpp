// How much of a target mesh the source covers. Where meshes overlap in part, a projection is over
// the covered region only, and the caller learns which vertices and tetrahedra are concerned.
#pragma once

#include "m2m/supermesh/moments.hpp"

#include <array>
#include <span>
#include <vector>

namespace tess::m2m {

/// A symmetric 4 × 4 matrix: entries 00 01 02 03 11 12 13 22 23 33.
using Symmetric4 = std::array<double, 10>;

/// The covered region C of a target tetrahedron. Several source parts contribute; they are added.
struct CellCoverage {
  double volume = 0;  ///< of C
  Symmetric4 mass{};  ///< integral over C of target weight a times target weight b

  void add(const PairMoments& moments);
  CellCoverage& operator+=(const CellCoverage& other);
};

/// A tetrahedron whose covered fraction exceeds 1 - full_coverage counts as covered.
inline constexpr double full_coverage = 1e-12;
/// A tetrahedron that is covered to a smaller fraction has a lumped mass matrix.
inline constexpr double consistent_coverage = 0.5;
/// What is covered to a smaller fraction counts as not covered.
inline constexpr double no_coverage = 1e-12;

/// The covered fraction of every tetrahedron, in [0, 1]; 0 for a tetrahedron without volume.
[[nodiscard]] std::vector<double> covered_fractions(std::span<const Point> points,
                                                    std::span<const Tet> tets,
                                                    std::span<const CellCoverage> coverage);

}  // namespace tess::m2m
