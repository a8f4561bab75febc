// One entry of a compressed field: decoded branch-free by look-ups and by the compressor that
// measures what they will see.
#pragma once

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/field/normal_code.hpp"

#include <bit>

namespace tess::dn {

struct Plane {
  float distance;  ///< at the cell's middle
  Normal normal;   ///< unit, or zero
};

/// What decoding needs, taken out of the layout once.
struct EntryDecoder {
  explicit EntryDecoder(const EntryLayout& layout)
      : bits(static_cast<std::uint32_t>(layout.normal_bits)),
        mask((1U << bits) - 1),
        middle(static_cast<std::int32_t>(mask >> 1U)),
        zero(1 << (31U - 2 * bits)),
        per_middle(middle > 0 ? 1 / static_cast<float>(middle) : 0),
        step(layout.step) {}

  /// 32 bits: distance above two coordinates of 0 … 2 middle; `mask` in the first: no normal.
  [[nodiscard]] Plane narrow(std::uint32_t word) const {
    const auto cu = static_cast<std::int32_t>((word >> bits) & mask);
    const auto cv = static_cast<std::int32_t>(word & mask);
    const float exists = cu == static_cast<std::int32_t>(mask) ? 0.0F : 1.0F;
    const float u = static_cast<float>(cu - middle) * per_middle;
    const float v = static_cast<float>(cv - middle) * per_middle;
    const float z = 1.0F - std::fabs(u) - std::fabs(v);
    const float fold = z < 0 ? -z : 0.0F;
    const float x = u - std::copysign(fold, u), y = v - std::copysign(fold, v);
    const float scale = exists / std::sqrt(x * x + y * y + z * z);
    const auto steps = static_cast<std::int32_t>(word >> (2 * bits)) - zero;
    return {static_cast<float>(steps) * step, {x * scale, y * scale, z * scale}};
  }
  [[nodiscard]] static Plane wide(std::uint32_t distance, std::uint32_t normal) {
    return {std::bit_cast<float>(distance), decode_normal(normal)};
  }

  std::uint32_t bits, mask;
  std::int32_t middle, zero;
  float per_middle, step;
};

/// The two coordinates of `normal` on the octahedral map that decode closest to it, or the code of
/// no normal for zero.
[[nodiscard]] std::uint32_t narrow_normal(const EntryDecoder& decoder, Vec3 normal);

inline Vec3 to_vec3(const Normal& n) {
  return {static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z)};
}

/// The distance of a voxel whose centre is (x, y, z) from the cell's middle.
inline float distance_to(const Plane& plane, float x, float y, float z, float thickness) {
  const float d = plane.distance + (plane.normal.x * x + plane.normal.y * y + plane.normal.z * z);
  const float above = d > -thickness ? d : -thickness;
  return above < thickness ? above : thickness;
}

}  // namespace tess::dn
