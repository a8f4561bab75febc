// A unit normal in 32 bits: the octahedral map (Meyer et al. 2010), 16 bits an axis, at most 5e-5
// rad off. Decoded normals are of unit length to rounding; the code no_normal stands for "no
// direction here" (medial axis, out of reach) and decodes to zero, which every rule leaves alone.
#pragma once

#include "collide/dn_field/vec3.hpp"

#include <cstdint>

namespace tess::dn {

inline constexpr float code_scale = 32767.0F;
inline constexpr std::uint32_t no_normal = 0x80008000U;

inline std::uint32_t encode_normal(Vec3 normal) {
  const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  if (!(sum > 0)) return no_normal;
  double u = normal.x / sum, v = normal.y / sum;
  if (normal.z < 0) {
    const double folded = (1 - std::abs(v)) * (u >= 0 ? 1 : -1);
    v = (1 - std::abs(u)) * (v >= 0 ? 1 : -1);
    u = folded;
  }
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

/// Branch-free, so that a loop over it becomes vector code.
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
