// The overlaps of target tetrahedra with the tetrahedra of a source piece, and the loads that a
// source field gives through them: the right-hand sides of a conservative transfer,
//
//     load_b(T) = integral over T of u_source psi_b
//               = sum over source tetrahedra S and corners a of (integral over S ∩ T of phi_a psi_b) u_a .
//
// The integrals depend on the meshes alone. A search computes them once (supermesh/moments.hpp).
#pragma once

#include "m2m/mesh_view.hpp"
#include "m2m/search/cover.hpp"
#include "m2m/supermesh/moments.hpp"
#include "m2m/transfer_kind.hpp"
#include "m2m/weights/rows.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

/// Target tetrahedra in boxes, and the boxes of the source's cover that are near to each.
struct TargetTets {
  std::vector<Corners> tets;
  std::vector<std::uint32_t> first{0};  ///< per box, and the end: its first tetrahedron
  std::vector<std::uint32_t> near{};    ///< boxes of the source's cover
  std::vector<std::uint32_t> first_near{0};
};

struct Overlaps {
  std::vector<std::uint32_t> targets;   ///< positions in TargetTets::tets, ascending
  std::vector<std::uint32_t> first{0};  ///< per target, and the end: its first overlap
  std::vector<std::int32_t> sources;    ///< per overlap: the tetrahedron; ascending ids per target
  std::vector<Matrix4> integrals;       ///< per overlap: of phi_a psi_b, as [a][b]
  std::uint64_t n_tested = 0;           ///< pairs of tetrahedra whose boxes overlap

  template <class Ar>
  void serialize(Ar& ar) {
    ar(targets, first, sources, integrals, n_tested);
  }
};

[[nodiscard]] Overlaps find_overlaps(const MeshView& source, const Cover& cover,
                                     const TargetTets& target);

/// The values of a source field.
struct SourceField {
  std::span<const double> values;  ///< row-major, a row per unknown
  std::size_t n_components = 1;
  Centring centring = Centring::nodes;

  /// The value of component c at corner a of a tetrahedron.
  [[nodiscard]] double at(const Tet& tet, std::int32_t number, std::size_t a, std::size_t c) const {
    const auto t = static_cast<std::size_t>(number);
    const std::size_t row = centring == Centring::nodes   ? static_cast<std::size_t>(tet[a])
                            : centring == Centring::cells ? t
                                                          : 4 * t + a;
    return values[row * n_components + c];
  }
};

/// The loads of one overlap: adds to out[b][c], for the corners b of the target.
void add_load(const MeshView& source, std::int32_t tet, const Matrix4& integrals,
              const SourceField& field, std::span<double> out);
/// The values of the source tetrahedron: extends out[c].
void add_range(const MeshView& source, std::int32_t tet, const SourceField& field,
               std::span<ValueRange> out);

}  // namespace tess::m2m
