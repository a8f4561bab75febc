#include "collide/dn_field/field/compressed_entry.hpp"

#include <algorithm>

namespace tess::dn {

std::uint32_t narrow_normal(const EntryDecoder& decoder, Vec3 normal) {
  const double sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  if (!(sum > 0)) return decoder.mask << decoder.bits;
  double u = normal.x / sum, v = normal.y / sum;
  if (normal.z < 0) {
    const double folded = (1 - std::abs(v)) * (u >= 0 ? 1 : -1);
    v = (1 - std::abs(u)) * (v >= 0 ? 1 : -1);
    u = folded;
  }
  const auto low = [&](double t) {
    return std::clamp(static_cast<int>(std::floor((t + 1) * decoder.middle)), 0,
                      2 * decoder.middle - 1);
  };
  std::uint32_t best = 0;
  double closest = -2;
  for (int corner = 0; corner < 4; ++corner) {
    const auto cu = static_cast<std::uint32_t>(low(u) + (corner & 1));
    const auto cv = static_cast<std::uint32_t>(low(v) + (corner >> 1));
    const std::uint32_t word = cu << decoder.bits | cv;
    const double agree = dot(to_vec3(decoder.narrow(word).normal), normal);
    if (agree > closest) closest = agree, best = word;
  }
  return best;
}

}  // namespace tess::dn
