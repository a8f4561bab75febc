// The kinds of transfer: how target values follow from source values.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace tess::m2m {

enum class TransferKind : std::uint8_t {
  linear,        ///< in the tetrahedron that holds the point: second order, bounded by its corners
  second_order,  ///< with recovered gradients: third order where the field is smooth, not bounded
  limited,       ///< the same, kept within the values at the corners of the tetrahedron
  nearest,       ///< the value of the nearest vertex, also outside: first order, bounded
  projection,    ///< linear, and outside at the nearest point of a cell: for walls, second order
  /// the polynomial that fits the values of the nearest vertices best, of clouds or of meshes, also
  /// outside: second order, or third (CouplingOptions::order); not bounded
  moving_least_squares,
  /// by the shape functions of the elements that tetrahedra were split from: second order and exact
  /// for trilinear fields in parallelepipeds, third order in quadratic elements; linear in others
  native,
  conservative,          ///< L2 projection: keeps the integral; second order, not bounded
  conservative_bounded,  ///< the same, kept within the source values that overlap
  conservative_lumped,   ///< with lumped masses: keeps integral and bounds, but smooths
};
inline constexpr std::array all_transfer_kinds{
    TransferKind::linear,
    TransferKind::second_order,
    TransferKind::limited,
    TransferKind::nearest,
    TransferKind::projection,
    TransferKind::moving_least_squares,
    TransferKind::native,
    TransferKind::conservative,
    TransferKind::conservative_bounded,
    TransferKind::conservative_lumped,
};

/// "linear", "second-order", "limited", "nearest", "projection", "moving-least-squares", "native",
/// "conservative", "conservative-bounded" or "conservative-lumped".
[[nodiscard]] const char* name_of(TransferKind kind) noexcept;
/// The kind of a name. Throws Error (bad_argument) for any other text.
[[nodiscard]] TransferKind parse_transfer_kind(const std::string& text);

/// Throws Error (bad_argument) if there is no such kind from cells of the dimension `source`
/// (TetMesh::dimension) to those of `target`: kinds with gradients need tetrahedra, and conservative
/// ones two meshes of tetrahedra, without a tolerance, or two of triangles.
void require_dimensions(TransferKind kind, double tolerance, std::int32_t source,
                        std::int32_t target);

/// Conservative kinds integrate over the intersections of tetrahedra, or of triangles; the others
/// give values at points.
[[nodiscard]] constexpr bool is_conservative(TransferKind kind) noexcept {
  return kind >= TransferKind::conservative;
}

/// How the normals of triangles that overlap may point: triangles of a file often have any order, and
/// walls of two bodies that touch face each other.
enum class Facing : std::uint8_t { either, same, opposite };

/// What the values of a field belong to.
enum class Centring : std::uint8_t {
  nodes,    ///< a value per point; linear in each tetrahedron
  cells,    ///< a value per tetrahedron
  corners,  ///< four values per tetrahedron, 4 t + corner: linear with jumps between tetrahedra
};

/// What has a row of values, for messages.
[[nodiscard]] constexpr const char* rows_of(Centring centring) noexcept {
  constexpr std::array names{"points", "tetrahedra", "corners of tetrahedra"};
  return names[static_cast<std::size_t>(centring)];
}

/// The layers of tetrahedra around a part that a kind needs, so that the result does not depend on
/// the partition: in the source, for gradients, or for the vertices of elements that are cut; in
/// the target, for masses and loads.
[[nodiscard]] constexpr std::int32_t source_halo_layers(TransferKind kind) noexcept {
  if (kind == TransferKind::native) return 1;
  return kind == TransferKind::second_order || kind == TransferKind::limited ? 2 : 0;
}
[[nodiscard]] constexpr std::int32_t target_halo_layers(TransferKind kind) noexcept {
  return is_conservative(kind) ? 1 : 0;
}

}  // namespace tess::m2m
