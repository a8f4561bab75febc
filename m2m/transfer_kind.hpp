// The kinds of transfer to points: how a value follows from the values at the source vertices.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace tess::m2m {

enum class TransferKind : std::uint8_t {
  linear,        ///< in the tetrahedron that holds the point: second order, bounded by its corners
  second_order,  ///< with recovered gradients: third order where the field is smooth, not bounded
  limited,       ///< the same, kept within the values at the corners of the tetrahedron
};

/// In the order of the enumeration. A new kind is also added here.
inline constexpr std::array all_transfer_kinds{TransferKind::linear, TransferKind::second_order,
                                               TransferKind::limited};

/// "linear", "second-order" or "limited".
[[nodiscard]] const char* name_of(TransferKind kind) noexcept;

/// The kind of this name. Throws Error (bad_argument) for any other text.
[[nodiscard]] TransferKind parse_transfer_kind(const std::string& text);

/// The layers of tetrahedra around a part that a kind needs, so that the result does not depend on
/// the partition.
[[nodiscard]] constexpr std::int32_t halo_layers(TransferKind kind) noexcept {
  return kind == TransferKind::linear ? 0 : 2;
}

}  // namespace tess::m2m
