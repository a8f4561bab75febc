#include "collide/dn_field/closest.hpp"

#include <algorithm>
#include <array>

namespace tess::dn {
namespace {

using namespace lanes;

/// Distance to the box of the grid along its furthest axis: no more than the true one.
F outside_by(const Placed& object, F3 g) {
  const auto beyond = [](F at, int n) { return max(-at, at - static_cast<float>(n - 1)); };
  return object.cell * max(max(beyond(g.x, object.field.n[0]), beyond(g.y, object.field.n[1])),
                           max(beyond(g.z, object.field.n[2]), F{}));
}

template <Stored How>
auto sampler_in(const Placed& object) {
  if constexpr (How == Stored::compressed) {
    return object.planes;
  } else {
    return object.field;
  }
}

template <LookUp Kind, Ask Asked, Setting Where, Sweep Swept, Stored How>
void pass(const Placed& object, const ParticleSpan& particles, Closest& closest) {
  const auto field = sampler_in<How>(object);
  const Vec3 c = object.centre;
  const auto& m = object.to_grid;
  const auto& r = object.to_world;
  const F ox = all(object.middle[0]), oy = all(object.middle[1]), oz = all(object.middle[2]);
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D3 from{load<D>(particles.x + p) - c.x,
                  load<D>(particles.y + p) - c.y,
                  load<D>(particles.z + p) - c.z};
    const F3 q{to_float(from.x), to_float(from.y), to_float(from.z)};
    F3 g;
    if constexpr (Where == Setting::one_at_rest)
      g = {q.x * m[0][0] + ox, q.y * m[1][1] + oy, q.z * m[2][2] + oz};
    else
      g = {q.x * m[0][0] + q.y * m[0][1] + q.z * m[0][2] + ox,
           q.x * m[1][0] + q.y * m[1][1] + q.z * m[1][2] + oy,
           q.x * m[2][0] + q.y * m[2][1] + q.z * m[2][2] + oz};
    Sample found = sample<Kind, Asked>(field, g);
    const I in = found.distance < out_of_reach;
    found.distance = in ? found.distance * object.scale - object.padding : found.distance;
    F free{};
    if constexpr (Swept == Sweep::on)
      free = in ? found.voxel * object.scale - object.doubt : outside_by(object, g);
    if constexpr (Where == Setting::one_at_rest) {
      store(closest.distance + p, found.distance);
      if constexpr (Asked == Ask::both) {
        store(closest.nx + p, found.normal.x);
        store(closest.ny + p, found.normal.y);
        store(closest.nz + p, found.normal.z);
      }
      if constexpr (Swept == Sweep::on) store(closest.free + p, free);
    } else {
      if constexpr (Swept == Sweep::on)
        store(closest.free + p, min(free, load<F>(closest.free + p)));
      const I nearer = found.distance < load<F>(closest.distance + p);
      const L nearer_wide = widen(nearer);
      if (!any(nearer_wide)) continue;
      store(closest.distance + p, nearer ? found.distance : load<F>(closest.distance + p));
      if constexpr (Asked == Ask::both) {
        const F3 n = found.normal;
        const auto keep = [&](float* to, const float(&row)[3]) {
          store(to, nearer ? n.x * row[0] + n.y * row[1] + n.z * row[2] : load<F>(to));
        };
        keep(closest.nx + p, r[0]);
        keep(closest.ny + p, r[1]);
        keep(closest.nz + p, r[2]);
      }
      // velocity + angular velocity × (p − position)
      const Frame& f = object.frame;
      const Vec3 w = f.angular_velocity, shift = c - f.position;
      const D3 arm{from.x + shift.x, from.y + shift.y, from.z + shift.z};
      const auto keep = [&](double* to, D value) { store(to, nearer_wide ? value : load<D>(to)); };
      keep(closest.ux + p, f.velocity.x + (w.y * arm.z - w.z * arm.y));
      keep(closest.uy + p, f.velocity.y + (w.z * arm.x - w.x * arm.z));
      keep(closest.uz + p, f.velocity.z + (w.x * arm.y - w.y * arm.x));
    }
  }
}

template <LookUp Kind, Stored How, Ask Asked, Setting Where>
ClosestPass choose(Sweep sweep) {
  return sweep == Sweep::on ? &pass<Kind, Asked, Where, Sweep::on, How>
                            : &pass<Kind, Asked, Where, Sweep::off, How>;
}
template <LookUp Kind, Stored How, Ask Asked>
ClosestPass choose(Setting setting, Sweep sweep) {
  return setting == Setting::general ? choose<Kind, How, Asked, Setting::general>(sweep)
                                     : choose<Kind, How, Asked, Setting::one_at_rest>(sweep);
}
template <LookUp Kind, Stored How>
ClosestPass choose(Ask asked, Setting setting, Sweep sweep) {
  return asked == Ask::distance ? choose<Kind, How, Ask::distance>(setting, sweep)
                                : choose<Kind, How, Ask::both>(setting, sweep);
}

}  // namespace

ClosestPass closest_pass(LookUp kind, Ask asked, Setting setting, Sweep sweep, Stored stored) {
  if (stored == Stored::compressed)
    return kind == LookUp::nearest
               ? choose<LookUp::nearest, Stored::compressed>(asked, setting, sweep)
               : choose<LookUp::tangent, Stored::compressed>(asked, setting, sweep);
  if (kind == LookUp::nearest) return choose<LookUp::nearest, Stored::flat>(asked, setting, sweep);
  if (kind == LookUp::tangent) return choose<LookUp::tangent, Stored::flat>(asked, setting, sweep);
  return choose<LookUp::trilinear, Stored::flat>(asked, setting, sweep);
}

Placed placed(const Object& object, LookUp kind) {
  const Field& field = *object.field;
  const Grid& grid = field.grid;
  const Frame& frame = object.frame;
  Placed result{};
  result.field = sampler_of(field);
  const Vec3 middle{0.5 * (grid.n[0] - 1), 0.5 * (grid.n[1] - 1), 0.5 * (grid.n[2] - 1)};
  result.centre = frame.to_world(grid.origin + grid.cell * middle);
  const double cell = grid.cell * frame.scale;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 axis = frame.axes[i], row = (1 / cell) * axis;
    for (int j = 0; j < 3; ++j) {
      result.to_grid[i][j] = static_cast<float>(component(row, j));
      result.to_world[j][i] = static_cast<float>(component(axis, j));
    }
    result.middle[i] = static_cast<float>(component(middle, static_cast<int>(i)));
  }
  result.scale = static_cast<float>(frame.scale);
  result.cell = static_cast<float>(cell);
  result.two_sided = field.sides == Sides::two;
  result.padding = result.two_sided && kind != LookUp::tangent ? static_cast<float>(cell) : 0.0F;
  result.doubt = static_cast<float>(0.5 * std::sqrt(3.0) * cell);
  result.compressed = object.compressed != nullptr;
  if (result.compressed) {
    result.planes = sampler_of(*object.compressed);
    result.doubt += static_cast<float>(object.compressed->measured.distance * frame.scale);
  }
  result.frame = frame;
  return result;
}

void clear(Closest& closest, std::size_t count) {
  std::fill_n(closest.distance, count, out_of_reach);
  std::fill_n(closest.free, count, out_of_reach);
  for (float* n : {closest.nx, closest.ny, closest.nz}) std::fill_n(n, count, 0.0F);
  for (double* u : {closest.ux, closest.uy, closest.uz}) std::fill_n(u, count, 0.0);
}

}  // namespace tess::dn
