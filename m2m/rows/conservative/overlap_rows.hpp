// Rows that integrate a source field against the basis functions of a target over the overlaps of
// their tetrahedra, or of their triangles (the supermesh): the right-hand sides of a conservative
// transfer,
//
//     load_i = integral of u_source psi_i = sum over a of w_ia u_a,
//     w_ia = sum over source tetrahedra S and target tetrahedra T of (integral over S ∩ T of phi_a psi_i) .
//
// The weights depend only on the meshes, so a search computes them once.
//
// Each integral is rounded to a multiple of the quantum of i, which is so large that all sums of
// integrals with psi_i are exact. So weights have the same bits for every order of addition:
// wherever the source is cut, and in as many sums as pieces overlap i. They are never negative:
// load_i / sum over a of w_ia is a mean of source values, however little of i is covered.
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/rows/search/cover.hpp"
#include "m2m/rows/supermesh/moments.hpp"
#include "m2m/rows/weights/rows.hpp"
#include "m2m/transfer_kind.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tess::m2m {

/// The quantum of a target unknown; `volume`: of all tetrahedra around the point, or of the cell.
[[nodiscard]] double quantum_of(double volume);

/// Target tetrahedra or triangles in boxes, and the boxes of the source's cover that are near to each
/// box.
struct TargetTets {
  std::vector<Corners> tets;
  std::vector<std::array<std::uint32_t, 4>> unknowns;  ///< per corner; those of a cell are equal
  std::vector<double> quanta;                          ///< per unknown
  std::uint32_t n_rows = 0;                            ///< the first unknowns get a row
  std::vector<std::uint32_t> first{0};  ///< per box, and the end: its first tetrahedron
  std::vector<std::uint32_t> near{};    ///< boxes of the source's cover
  std::vector<std::uint32_t> first_near{0};
  std::int32_t dimension = 3;
  double tolerance = 0;  ///< how far triangles that overlap may be apart
  Facing facing{};       ///< of these
};

struct OverlapRows {
  Rows<double> rows;  ///< per target unknown, columns are unknowns of the source
  std::vector<std::uint32_t>
      tets;  ///< positions in TargetTets::tets of those that overlap, ascending
  std::vector<std::array<double, 4>>
      covered;                 ///< per entry of tets and corner: loads of the constant 1
  std::uint64_t n_tested = 0;  ///< pairs of tetrahedra that no face clearly separates
};

/// The number of unknowns of a part of a mesh, and their ids.
[[nodiscard]] std::size_t n_unknowns(const MeshView& mesh, Centring centring);
[[nodiscard]] GlobalId id_of_unknown(const MeshView& mesh, Centring centring, VertexId unknown);

/// Columns of a row are in ascending order of ids. `cover`: of the source's own tetrahedra.
[[nodiscard]] OverlapRows overlap_rows(const MeshView& source, Centring centring,
                                       const Cover& cover, const TargetTets& target);

}  // namespace tess::m2m
