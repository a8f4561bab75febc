#include "apps/bench/dn_by_hand.hpp"

#include "collide/dn_field/particle_lanes.hpp"
#include "collide/dn_field/sample.hpp"

#include <algorithm>

namespace bench {

using namespace tess::dn;
using namespace tess::dn::lanes;

namespace {

/// A vector of particles at a time, in blocks that stay in the first cache for all their steps;
/// `all` is a multiple of eight. `take` holds copies, which no store to a particle can change.
template <class Step>
void in_vectors(const ParticleSpan& all, Step take) {
  constexpr std::size_t block = 256;
  for (std::size_t first = 0; first < all.count; first += block) {
    const ParticleSpan b = all.part(first, std::min(block, all.count - first));
    for (int i = 0; i < n_steps; ++i)
      for (std::size_t p = 0; p < b.count; p += width) {
        D3 x = places(b, p), v = velocities(b, p);
        take(x, v);
        set_places(b, p, x), set_velocities(b, p, v);
      }
  }
}

/// The voxels of a field at rest.
struct Nearest {
  explicit Nearest(const Field& field)
      : sampler(sampler_of(field)),
        origin(field.grid.origin),
        per_cell(static_cast<float>(1 / field.grid.cell)) {}

  [[nodiscard]] Voxel operator()(D3 x) const {
    return voxel_from_corner(sampler.n,
                             {to_float(x.x - origin.x) * per_cell + 0.5F,
                              to_float(x.y - origin.y) * per_cell + 0.5F,
                              to_float(x.z - origin.z) * per_cell + 0.5F});
  }

  Sampler sampler;
  Vec3 origin;
  float per_cell;
};

}  // namespace

void gravity_by_hand(const ParticleSpan& all, Vec3 g) {
  const Vec3 dv = step * g, half_dv = 0.5 * dv;
  in_vectors(all, [=](D3& x, D3& v) {
    x = {x.x + step * (v.x + half_dv.x),
         x.y + step * (v.y + half_dv.y),
         x.z + step * (v.z + half_dv.z)};
    v = {v.x + dv.x, v.y + dv.y, v.z + dv.z};
  });
}

void air_drag_by_hand(const ParticleSpan& all, double rate) {
  const double keep = std::exp(-rate * step), way = -std::expm1(-rate * step) / rate;
  in_vectors(all, [=](D3& x, D3& v) {
    x = x + lanes::all(way) * v;
    v = lanes::all(keep) * v;
  });
}

void surface_drag_by_hand(const ParticleSpan& all, const Field& field, double rate, double reach) {
  const double keep = std::exp(-rate * step), way = -std::expm1(-rate * step) / rate;
  const Nearest voxel_at(field);
  in_vectors(all, [=](D3& x, D3& v) {
    const Voxel voxel = voxel_at(x);
    const F d = gather(voxel_at.sampler.distance, position(voxel_at.sampler, voxel));
    const L near = widen(voxel.in & (d < static_cast<float>(reach)));
    x = fma(near ? lanes::all(way) : lanes::all(step), v, x);
    v = (near ? lanes::all(keep) : lanes::all(1.0)) * v;
  });
}

void impact_by_hand(const ParticleSpan& all, const Field& field) {
  const Nearest voxel_at(field);
  in_vectors(all, [=](D3& x, D3& v) {
    const Voxel voxel = voxel_at(x);
    const I at = position(voxel_at.sampler, voxel);
    const F distance = gather(voxel_at.sampler.distance, at);
    const D d = to_double(distance), way2 = (step * step) * dot(v, v);
    const L may = widen(voxel.in) & ((d < 0.0) | (d * d < way2));
    D3 way = lanes::all(step) * v;
    if (any(may)) {
      const D3 n = refined(to_double(unit(decode(gather(voxel_at.sampler.normal, at)))));
      const D rise = dot(n, way);
      const L hits = may & (rise < 0.0) & (d + rise < 0.0);
      const D rest = 1.0 - max(-d / rise, D{}), kick = only(hits, -2.0 * rise);
      way = select(hits, fma(rest * kick, n, way), way);
      v = fma(kick * (1 / step), n, v);
    }
    x = x + way;
  });
}

}  // namespace bench
