#include "apps/bench/dn_by_hand.hpp"

#include "collide/dn_field/normal_code.hpp"

#include <algorithm>

namespace bench {

using namespace tess::dn;

void gravity_by_hand(const ParticleSpan& all, Vec3 g) {
  constexpr std::size_t block = 256;
  const Vec3 dv = step * g, half_dv = 0.5 * dv;
  for (std::size_t first = 0; first < all.count; first += block) {
    const ParticleSpan b = all.part(first, std::min(block, all.count - first));
    for (int i = 0; i < n_steps; ++i) {
#pragma GCC ivdep
      for (std::size_t p = 0; p < b.count; ++p) {
        b.x[p] += step * (b.vx[p] + half_dv.x);
        b.y[p] += step * (b.vy[p] + half_dv.y);
        b.z[p] += step * (b.vz[p] + half_dv.z);
        b.vx[p] += dv.x;
        b.vy[p] += dv.y;
        b.vz[p] += dv.z;
      }
    }
  }
}

void impact_by_hand(const ParticleSpan& all, const Field& field) {
  constexpr std::size_t block = 256;
  const Grid& g = field.grid;
  const double per_cell = 1 / g.cell;
  for (std::size_t first = 0; first < all.count; first += block) {
    const ParticleSpan b = all.part(first, std::min(block, all.count - first));
    for (int i = 0; i < n_steps; ++i)
      for (std::size_t p = 0; p < b.count; ++p) {
        const double u = (b.x[p] - g.origin.x) * per_cell + 0.5,
                     v = (b.y[p] - g.origin.y) * per_cell + 0.5,
                     w = (b.z[p] - g.origin.z) * per_cell + 0.5;
        double kick = 0, rest = 0;
        Normal n{};
        if (u >= 0 && v >= 0 && w >= 0 && u < g.n[0] && v < g.n[1] && w < g.n[2]) {
          const std::size_t at =
              g.index(static_cast<int>(u), static_cast<int>(v), static_cast<int>(w));
          const double d = static_cast<double>(field.distance[at]);
          const double speed2 = b.vx[p] * b.vx[p] + b.vy[p] * b.vy[p] + b.vz[p] * b.vz[p];
          if (d < 0 || d * d < step * step * speed2) {
            n = decode_normal(field.normal[at]);
            const double rise = b.vx[p] * static_cast<double>(n.x) +
                                b.vy[p] * static_cast<double>(n.y) +
                                b.vz[p] * static_cast<double>(n.z);
            if (rise < 0 && d + step * rise < 0) {
              kick = -2 * rise;
              rest = 1 - std::max(0.0, -d / (step * rise));
            }
          }
        }
        const double kx = kick * static_cast<double>(n.x), ky = kick * static_cast<double>(n.y),
                     kz = kick * static_cast<double>(n.z);
        b.x[p] += step * (b.vx[p] + rest * kx);
        b.y[p] += step * (b.vy[p] + rest * ky);
        b.z[p] += step * (b.vz[p] + rest * kz);
        b.vx[p] += kx, b.vy[p] += ky, b.vz[p] += kz;
      }
  }
}

}  // namespace bench
