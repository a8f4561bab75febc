// Rows that integrate a source field against the target's basis functions over the supermesh: the
// right-hand sides of a conservative transfer,
//
//     load_i = integral of u_source psi_i = sum over a of (integral of phi_a psi_i) u_a .
//
// A source part computes rows from its own tetrahedra and from the target tetrahedra that overlap
// them; the loads of all source parts add up at the target. All weights of vertices and tetrahedra
// are >= 0 up to rounding.
#pragma once

#include "m2m/conservative/coverage.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/weights/rows.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// What the unknowns of a field are.
enum class Basis {
  vertex,  ///< continuous and linear: a value per vertex
  cell,    ///< constant in each tetrahedron: a value per tetrahedron
  corner,  ///< linear in each tetrahedron, with jumps: four values per tetrahedron, 4 t + corner
};

/// A source and a target tetrahedron that may overlap, as positions in two MeshViews.
struct TetPair {
  std::int32_t source;
  std::int32_t target;
};

struct Loads {
  Rows<double> rows;                   ///< per target unknown
  std::vector<CellCoverage> coverage;  ///< per target tetrahedron
  std::uint64_t n_overlaps = 0;        ///< pairs with a volume in common
};

/// `pairs`: each pair once. Contributions are added in the order of the pairs; for results that do
/// not depend on the decomposition list them in the order of global ids. `source_basis` and
/// `target_basis` may be any combination.
[[nodiscard]] Loads integrate_pairs(MeshView source, Basis source_basis, MeshView target,
                                    Basis target_basis, std::span<const TetPair> pairs);

/// Mean values of target tetrahedra: value = load / covered volume, per component, in place.
/// `loads`: of Basis::cell, summed over all source parts. A tetrahedron covered to less than
/// no_coverage gets `fallback`.
void cell_means(MeshView target, std::span<const CellCoverage> coverage, std::size_t n_components,
                double fallback, std::span<double> loads);

}  // namespace tess::m2m
