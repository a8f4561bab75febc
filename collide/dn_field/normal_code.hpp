// A unit normal in 32 bits: the octahedral map (Meyer et al. 2010), 16 bits per axis, error at most
// 5e-5 rad. Decoded normals have unit length to rounding. The code no_normal (on the medial axis,
// out of reach) decodes to zero, which every rule ignores.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <cstdint>

namespace tess::dn {

inline constexpr float code_scale = 32767.0F;
inline constexpr std::uint32_t no_normal = 0x80008000U;

struct OctahedralPoint {
  double u, v;  ///< within [−1, 1]
};
/// Of a vector other than zero.
inline OctahedralPoint on_octahedral_map(Vec3 normal) {
  const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  const double u = normal.x / sum, v = normal.y / sum;
  if (!(normal.z < 0)) return {u, v};
  return {(1 - std::abs(v)) * (u >= 0 ? 1 : -1), (1 - std::abs(u)) * (v >= 0 ? 1 : -1)};
}

inline std::uint32_t encode_normal(Vec3 normal) {
  if (!(std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z) > 0)) return no_normal;
  const auto [u, v] = on_octahedral_map(normal);
  const auto bits = [](double t) {
    return static_cast<std::uint32_t>(
               static_cast<std::int32_t>(std::lround(t * static_cast<double>(code_scale)))) &
           0xFFFFU;
  };
  return bits(u) | bits(v) << 16U;
}

struct Normal {
  float x, y, z;
};

/// Branch-free, so that a loop over it is vectorised.
inline Normal decode_normal(std::uint32_t code) {
  const float exists = code == no_normal ? 0.0F : 1.0F;
  const float u =
      static_cast<float>(static_cast<std::int32_t>(code << 16U) >> 16) * (1 / code_scale);
  const float v = static_cast<float>(static_cast<std::int32_t>(code) >> 16) * (1 / code_scale);
  const float z = 1.0F - std::fabs(u) - std::fabs(v);
  const float fold = z < 0 ? -z : 0.0F;
  const float x = u - std::copysign(fold, u), y = v - std::copysign(fold, v);
  const float scale = exists / std::sqrt(x * x + y * y + z * z);
  return {x * scale, y * scale, z * scale};
}

}  // namespace tess::dn
