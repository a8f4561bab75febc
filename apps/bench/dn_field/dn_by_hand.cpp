#include "apps/bench/dn_field/dn_by_hand.hpp"

#include "collide/dn_field/field/sample.hpp"
#include "collide/dn_field/geometry/lanes.hpp"

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

  [[nodiscard]] F3 grid(D3 x) const {
    return {to_float(x.x - origin.x) * per_cell, to_float(x.y - origin.y) * per_cell,
            to_float(x.z - origin.z) * per_cell};
  }
  [[nodiscard]] Voxel operator()(D3 x) const { return voxel_of(sampler.n, grid(x)); }

  Sampler sampler;
  Vec3 origin;
  float per_cell;
};

}  // namespace

void gravity_by_hand(const ParticleSpan& all, Vec3 g) {
  const Vec3 dv = step * g, half_dv = 0.5 * dv;
  in_vectors(all, [=](D3& x, D3& v) {
    x = {x.x + step * (v.x + half_dv.x), x.y + step * (v.y + half_dv.y),
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

void explosion_by_hand(const ParticleSpan& all, const Explosion& explosion) {
  const Vec3 centre = explosion.centre;
  const double kick = explosion.strength * step, per_radius = 1 / explosion.radius;
  in_vectors(all, [=](D3& x, D3& v) {
    const D3 from = x - centre;
    const D per_r = 1.0 / sqrt(dot(from, from));
    v = fma(only(per_r > per_radius, kick * (per_r - per_radius)), from, v);
    x = fma(lanes::all(step), v, x);
  });
}

void flow_by_hand(const ParticleSpan& all, const Field& field, const SurfaceFlow& flow) {
  const Nearest voxel_at(field);
  in_vectors(all, [=](D3& x, D3& v) {
    const Voxel voxel = voxel_at(x);
    const I at = position(voxel_at.sampler, voxel);
    const L near = widen(
        voxel.in & (gather(voxel_at.sampler.distance, at) < static_cast<float>(flow.distance)));
    if (any(near)) {
      const D3 n = refined(to_double(unit(decode(gather(voxel_at.sampler.normal, at)))));
      const D alpha = dot(v, n), v2 = dot(v, v), speed = sqrt(v2), rise = abs(alpha);
      const D rate = alpha < 0.0 ? lanes::all(flow.alpha_in) : lanes::all(flow.alpha_out);
      // To the tangent: sine |alpha|/|v|, cosine along/|v|.
      const D along = sqrt(max(v2 - alpha * alpha, D{}));
      Turn by = turn(min(step * rate / speed, lanes::all(0.5 * pi)));
      const L arrives = by.sine * speed > rise;
      by = {arrives ? along / speed : by.cosine, arrives ? rise / speed : by.sine};
      const D side = (alpha < 0.0 ? by.sine : -by.sine) / along;
      const D3 turned = fma(by.cosine - side * alpha, v, (side * v2) * n);
      v = select(near & (along > 1e-6 * speed), turned, v);
    }
    x = fma(lanes::all(step), v, x);
  });
}

void spring_by_hand(const ParticleSpan& all, const Field& field, const Spring& spring) {
  constexpr std::size_t block = 256;
  const Nearest voxel_at(field);
  const double k = spring.stiffness, gamma = 0.5 * spring.damping,
               omega = std::sqrt(k - gamma * gamma), kept = std::exp(-gamma * step),
               cosine = kept * std::cos(omega * step), sine = kept * std::sin(omega * step);
  struct Found {
    D z;  // beyond the spring's reach
    D3 n;
  };
  const auto look = [&](D3 x) {
    const F3 g = voxel_at.grid(x);
    const Voxel voxel = voxel_of(voxel_at.sampler.n, g);
    const I at = position(voxel_at.sampler, voxel);
    const F3 n = unit(decode(gather(voxel_at.sampler.normal, at)));
    // By the tangent: constant in a voxel no spring is passive.
    const F d =
        gather(voxel_at.sampler.distance, at) + voxel_at.sampler.cell * dot(n, offset(voxel, g));
    return Found{to_double(voxel.in ? d : lanes::all(out_of_reach)) - spring.reach,
                 refined(to_double(n))};
  };
  for (std::size_t first = 0; first < all.count; first += block) {
    const ParticleSpan b = all.part(first, std::min(block, all.count - first));
    Found known[block / width];
    for (std::size_t p = 0; p < b.count; p += width) known[p / width] = look(places(b, p));
    for (int i = 0; i < n_steps; ++i)
      for (std::size_t p = 0; p < b.count; p += width) {
        const auto [z, n] = known[p / width];
        D3 x = places(b, p), v = velocities(b, p);
        const D e = dot(n, v), depth = min(z, D{});
        const D energy = dot(v, v) + k * depth * depth;
        const D swing = (e + gamma * z) * (1 / omega);
        const D end = cosine * z + sine * swing;
        const D rate = cosine * e - sine * (gamma * swing + omega * z);
        const L stays = (z < 0.0) & (end <= 0.0);
        x = x + lanes::all(step) * v + only(stays, end - z - step * e) * n;
        v = v + only(stays, rate - e) * n;
        Found next = look(x);
        const D depth1 = max(-next.z, D{}), kinetic = dot(v, v),
                left = energy - k * depth1 * depth1;
        const L over = (depth1 > 0.0) & (kinetic - left > 1e-6 * energy);
        v = select(over, sqrt(only(left > 0.0, left / kinetic)) * v, v);
        const L deeper = over & (left < 0.0);
        if (any(deeper)) {
          const D push = depth1 - sqrt(energy * (1 / k));
          x = select(deeper, fma(push, next.n, x), x);
          next = look(x);
        }
        set_places(b, p, x), set_velocities(b, p, v);
        known[p / width] = next;
      }
  }
}

}  // namespace bench
