#include "collide/dn_field/rules/nearest_surface.hpp"

#include <algorithm>
#include <tuple>

namespace tess::dn {
namespace {

using namespace lanes;

constexpr std::int32_t unknown = -1;

/// sample() of distance and normal for particles p, p + 1, …. Only those in
/// another voxel than in `last` fetch from the field; the others keep the values.
template <LookUp Kind>
Sample sample_again(const Sampler& field, F3 g, const NearestSurface& last, NearestSurface& nearest,
                    std::size_t p) {
  const Voxel voxel = voxel_of(field.n, g);
  const I key = voxel.in ? position(field, voxel) : I{} + unknown;
  const I changed = ~voxel.in | (key != load<I>(last.voxel + p));
  Stored stored{load<F>(last.stored + p), normals(last, p)};
  if (any(changed)) stored = read_changed(field, voxel, changed, stored);
  store(nearest.voxel + p, key);
  store(nearest.stored + p, stored.distance);
  return answer<Kind>(field.cell, voxel, stored, g);
}

/// The bound of the free way where another object may move by `way` against it.
F shortened(const PlacedObject& object, F bound, F way) {
  const F rest = bound - way;
  return ((rest < 0.0F) & (way > 0.5F * object.cell)) ? all(follow) : rest;
}

/// Deviation from a straight way, by a spin, of a point that rests on the object at `arm`.
F bent(const PlacedObject& object, D3 arm) {
  const F3 q = to_float(arm);
  return 0.5F * object.spin * object.spin * sqrt(dot(q, q));
}

/// What growth subtracts from the free way. In the object's coordinates, where its surface rests,
/// the particle's way is the one in the world divided by the scale at the end, and is relative to
/// the velocity at the particle's place, not at the surface beside it.
F taken_by_growth(const PlacedObject& object, F free, I in, F distance) {
  const auto g = static_cast<float>(object.growth);
  return std::max(-g, 0.0F) * max(free + object.stopped, F{}) +
         std::fabs(g) * abs(only(in, distance));
}

template <LookUp Kind, Ask Asked, Setting Where, Sweep Swept, bool Compressed>
void pass(const PlacedObject& __restrict object,  // no store can change it
          const ParticleSpan& __restrict particles, [[maybe_unused]] const NearestSurface& last,
          NearestSurface& nearest) {
  const auto field = std::get < Compressed ? 1 : 0 > (std::tie(object.field, object.planes));
  const Vec3 c = object.centre;
  const auto& m = object.to_grid;
  const F ox = all(object.middle[0]), oy = all(object.middle[1]), oz = all(object.middle[2]);
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D3 from = places(particles, p) - c;
    const F3 q = to_float(from);
    F3 g;
    if constexpr (Where == Setting::one_at_rest)
      g = {q.x * m[0][0] + ox, q.y * m[1][1] + oy, q.z * m[2][2] + oz};
    else
      g = to_grid(object, q);
    Sample found;
    if constexpr (Where == Setting::one_at_rest && Kind != LookUp::trilinear &&
                  Asked == Ask::both && !Compressed)
      found = sample_again<Kind>(field, g, last, nearest, p);
    else
      found = sample<Kind, Asked>(field, g);
    [[maybe_unused]] const I in = found.in;
    F free{};
    if constexpr (Swept == Sweep::on) free = free_in_world(object, found, g);
    found.distance = distance_in_world(object, found);
    if constexpr (Where == Setting::one_at_rest) {
      store(nearest.distance + p, found.distance);
      if constexpr (Asked == Ask::both) {
        store(nearest.nx + p, found.normal.x);
        store(nearest.ny + p, found.normal.y);
        store(nearest.nz + p, found.normal.z);
      }
      if constexpr (Swept == Sweep::on) store(nearest.free + p, free);
    } else {
      const I nearer = found.distance < load<F>(nearest.distance + p);
      const L nearer_wide = widen(nearer);
      const Frame& f = object.frame;
      const Vec3 shift = c - f.position;
      D3 u{};
      [[maybe_unused]] F bend{};
      if (object.restless) {
        const D3 arm = from + shift;
        if constexpr (Swept == Sweep::on) bend = bent(object, arm);
        u = stiff_velocity(f, arm);
        if (object.growth != 0) {
          // The velocity of the surface itself, which is beside the particle.
          const F3 beside = only(in, found.distance * to_world(object, found.normal));
          u = u + all(f.scale_rate / f.scale) * (arm - to_double(beside));
        }
      }
      if constexpr (Swept == Sweep::on) {
        F others = load<F>(nearest.free + p);
        if (object.growth != 0) free = free - taken_by_growth(object, free, in, found.distance);
        if (object.spin != 0) free = shortened(object, free * (1 / (1 + object.spin)), bend);
        // Where this is the only surface so far there is nothing to compare.
        if (object.restless && bits((others < out_of_reach) | ~nearer) != 0) {
          const D3 gap = u - surface_velocities(nearest, p);
          const F way = to_float(object.step * sqrt(dot(gap, gap)));
          others = nearer ? shortened(object, others, way) : others;
          free = nearer ? free : shortened(object, free, way);
        }
        store(nearest.free + p, min(free, others));
      }
      if (!any(nearer_wide)) continue;
      store(nearest.distance + p, nearer ? found.distance : load<F>(nearest.distance + p));
      if constexpr (Asked == Ask::both) {
        const F3 n = to_world(object, found.normal);
        const auto keep = [&](float* to, F value) { store(to, nearer ? value : load<F>(to)); };
        keep(nearest.nx + p, n.x);
        keep(nearest.ny + p, n.y);
        keep(nearest.nz + p, n.z);
      }
      const auto keep = [&](double* to, D value) { store(to, nearer_wide ? value : load<D>(to)); };
      keep(nearest.ux + p, u.x);
      keep(nearest.uy + p, u.y);
      keep(nearest.uz + p, u.z);
    }
  }
}

}  // namespace

NearestPass nearest_pass(LookUp kind, Ask asked, Setting setting, Sweep sweep, bool compressed) {
  return with<LookUp::nearest, LookUp::tangent, LookUp::trilinear>(kind, [=]<LookUp Kind> {
    return with<false, true>(compressed, [=]<bool Compressed> {
      return with<Ask::distance, Ask::both>(asked, [=]<Ask Asked> {
        return with<Setting::one_at_rest, Setting::general>(setting, [=]<Setting Where> {
          return with<Sweep::off, Sweep::on>(sweep, [=]<Sweep Swept>() -> NearestPass {
            // The tangent reads the normal; compressed fields have no trilinear look-up.
            constexpr Ask reads = Kind == LookUp::tangent ? Ask::both : Asked;
            if constexpr (Kind == LookUp::trilinear && Compressed)
              return nullptr;
            else
              return &pass<Kind, reads, Where, Swept, Compressed>;
          });
        });
      });
    });
  });
}

double jump_of(const Field& field) {
  return static_cast<double>(field.jump) + 2 * compression_error(field);
}

PlacedObject placed(const Object& object, LookUp kind, double step, bool restless,
                    double threshold) {
  const Field& field = *object.field;
  const Grid& grid = field.grid;
  const Frame& frame = object.frame;
  PlacedObject result{};
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
  if (field.sides == Sides::two) result.padding = open_surface_clearance(kind) * result.cell;
  result.stopped = result.padding + static_cast<float>(threshold);
  result.jump = static_cast<float>(jump_of(field) * frame.scale);
  result.compressed = field.planes != nullptr;
  if (result.compressed) result.planes = plane_sampler_of(field);
  result.error = static_cast<float>(compression_error(field) * frame.scale);
  result.doubt = half_diagonal * static_cast<float>(cell) + result.error;
  result.frame = frame;
  result.step = step;
  result.growth = step * frame.scale_rate / frame.scale;
  result.spin = static_cast<float>(step * norm(frame.angular_velocity));
  const Vec3 high =
      grid.origin + grid.cell * Vec3{1.0 * grid.n[0], 1.0 * grid.n[1], 1.0 * grid.n[2]};
  const auto furthest = [&](int axis) {
    return std::max(std::abs(component(grid.origin, axis)) + grid.cell,
                    std::abs(component(high, axis)));
  };
  result.swell = std::abs(frame.scale_rate) * norm(Vec3{furthest(0), furthest(1), furthest(2)});
  result.restless = restless;
  return result;
}

void forget(NearestSurface& nearest, std::size_t count) {
  std::fill_n(nearest.voxel, count, unknown);
}

void clear(NearestSurface& nearest, std::size_t count) {
  std::fill_n(nearest.distance, count, out_of_reach);
  std::fill_n(nearest.free, count, out_of_reach);
  for (float* n : {nearest.nx, nearest.ny, nearest.nz}) std::fill_n(n, count, 0.0F);
  for (double* u : {nearest.ux, nearest.uy, nearest.uz}) std::fill_n(u, count, 0.0);
}

}  // namespace tess::dn
