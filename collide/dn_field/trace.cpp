#include "collide/dn_field/trace.hpp"

#include "collide/dn_field/placed_lanes.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

using namespace lanes;

constexpr int max_bounces = 16;
// The shortest advances, in cells: into the next voxel; of blends, thinner than what a grid
// resolves.
constexpr float into_next = 1e-3F, blend_stride = 0.25F;
constexpr double never = HUGE_VAL;

Sample sample_of(const Placed& object, LookUp kind, F3 g) {
  if (kind == LookUp::trilinear) return sample<LookUp::trilinear, Ask::both>(object.field, g);
  if (kind == LookUp::nearest)
    return object.compressed ? sample<LookUp::nearest, Ask::both>(object.planes, g)
                             : sample<LookUp::nearest, Ask::both>(object.field, g);
  return object.compressed ? sample<LookUp::tangent, Ask::both>(object.planes, g)
                           : sample<LookUp::tangent, Ask::both>(object.field, g);
}

/// The part of `way`, in grid coordinates, that stays in the voxel of g.
F way_in_voxel(F3 g, F3 way) {
  const auto along = [](F at, F by) {
    const F h = at + 0.5F, in = h - floor(h);
    return by == 0.0F ? all(HUGE_VALF) : (by > 0.0F ? 1.0F - in : in) / abs(by);
  };
  return min(min(along(g.x, way.x), along(g.y, way.y)), along(g.z, way.z));
}

/// What one object's field says at points p of a way, in world units.
struct Here {
  D distance;  ///< `never` outside of the field
  D3 normal;   ///< unit or zero
  D stride;    ///< part of the way for which that holds, or which is free
};

Here ask(const Placed& object, LookUp kind, D3 p, D3 way) {
  const D3 from = p - object.centre;
  const F3 g = to_grid(object, to_float(from));
  const Sample found = sample_of(object, kind, g);
  const I in = found.distance < out_of_reach;
  const D distance = to_double(distance_in_world(object, found));
  const F free = free_in_world(object, found, g);
  const D3 n = to_double(only(in, to_world(object, found.normal)));
  const F3 w = turned_to_grid(object, to_float(way));
  const F per_cell = 1.0F / sqrt(dot(w, w));
  const F held = kind == LookUp::trilinear ? blend_stride * per_cell
                                           : (in ? way_in_voxel(g, w) : F{}) + into_next * per_cell;
  const F stride = max(free / object.cell * per_cell, held);
  return {widen(in) ? distance : all(never), refined(n), to_double(stride)};
}

struct Contact {
  D at = all(never);  ///< fraction of the step
  D3 normal{}, surface_velocity{};
  D too_deep{};
};
Contact select(L mask, const Contact& a, const Contact& b) {
  return {mask ? a.at : b.at,
          select(mask, a.normal, b.normal),
          select(mask, a.surface_velocity, b.surface_velocity),
          mask ? a.too_deep : b.too_deep};
}

/// A straight way in the world as seen from an object, at the size it has when the step begins: a
/// straight way, too, which a growing object sees slow down. Fractions f of the step and of that
/// way, t, are the same without growth; else t = f/(1 + f g), where 1 + f g is the scale at f over
/// that at the begin.
struct Seen {
  D3 from, way;
  double growth;

  [[nodiscard]] D size(D f) const { return 1.0 + f * growth; }
  [[nodiscard]] D seen(D f) const { return growth == 0 ? f : f / size(f); }
  [[nodiscard]] D in_step(D t) const {
    if (growth == 0) return t;
    return t * growth < 1.0 ? t / (1.0 - t * growth) : all(never);
  }
};

/// `x`: where the particles are after the fraction `elapsed` of the step, and fly by `way` a step.
Seen seen_from(const Placed& object, double step, D3 x, D3 way, D elapsed) {
  const D3 position = all(object.frame.position), from = x - elapsed * way;
  D3 seen = fma(all(-step), stiff_velocity(object.frame, x - position), way);
  if (object.growth != 0) seen = fma(all(-object.growth), from - position, seen);
  return {from, seen, object.growth};
}

/// The velocity of the object's surface where it passes p.
D3 surface_velocity(const Frame& frame, D3 p) {
  const D3 arm = p - frame.position, stiff = stiff_velocity(frame, arm);
  return frame.is_growing() ? fma(all(frame.scale_rate / frame.scale), arm, stiff) : stiff;
}

struct Scene {
  const RuleConstants& constants;
  std::span<const Placed> objects;
  LookUp kind;
};

/// The first contacts on x + s × way, 0 <= s <= rest, from the fraction 1 − rest of the step on,
/// for particles that fly; `at` is `never` where there is none. `rest` is shortened where the way
/// could not be followed to its end.
Contact first_contact(const Scene& scene, D3 x, D3 way, D& rest, L flies) {
  const auto& [c, objects, kind] = scene;
  std::size_t budget = 1024;  // advances; each leads into another voxel
  for (const Placed& object : objects)
    budget +=
        8 * static_cast<std::size_t>(object.field.n[0] + object.field.n[1] + object.field.n[2]);
  const D elapsed = 1.0 - rest;
  Contact first;
  D s{};
  for (L going = flies & (s <= rest); any(going); going = going & (s <= rest)) {
    if (budget-- == 0) {
      rest = going ? s : rest;
      break;
    }
    D next = all(never);
    Contact contact;
    for (const Placed& object : objects) {
      const Seen seen = seen_from(object, c.step, x, way, elapsed);
      const D t = seen.seen(elapsed + s), size = seen.size(elapsed + s);
      const D3 p = fma(t, seen.way, seen.from);
      const Here here = ask(object, kind, p, seen.way);
      const auto cell = static_cast<double>(object.cell);
      const L moves = dot(seen.way, seen.way) > 0.0;
      next = moves ? min(next, seen.in_step(t + here.stride) - elapsed) : next;
      const D rise = dot(here.normal, seen.way);
      // Both sides of a sheet look alike: turn back before it is as close as the look-up errs.
      D threshold = seen.growth == 0 ? all(c.threshold) : c.threshold / size;
      if (object.two_sided)
        threshold = max(threshold, all(cell - static_cast<double>(object.padding)));
      const D met = t + max((here.distance - threshold) / -rise, D{});
      const D at = seen.in_step(met) - elapsed;
      const L touches = settled(moves & (rise < 0.0) & (here.distance < never) &
                                (met <= t + here.stride) & (at < contact.at));
      if (!any(touches)) continue;
      D3 surface = p;
      if (object.growth != 0) surface = fma(met, seen.way, fma(-threshold, here.normal, seen.from));
      const D too_deep = max(c.threshold - c.slack - here.distance * size, D{});
      contact = select(
          touches, {at, here.normal, surface_velocity(object.frame, surface), too_deep}, contact);
    }
    const L found = going & (contact.at <= next) & (contact.at <= rest);
    first = select(found, contact, first);
    going = going & ~found & (next < never);
    s = going ? next : all(never);
  }
  return first;
}

L finite(D3 v) {
  const D size = abs(v.x) + abs(v.y) + abs(v.z);
  return size < never;
}

/// As many as a vector holds, or fewer.
void trace_vector(const Scene& scene,
                  std::span<const Untraced> from,
                  const ParticleSpan& particles,
                  double* energy) {
  const RuleConstants& c = scene.constants;
  const auto lane = [&](Vec3 Untraced::*what) {
    D3 v{};
    for (std::size_t i = 0; i < from.size(); ++i) {
      const Vec3 value = from[i].*what;
      v.x[i] = value.x, v.y[i] = value.y, v.z[i] = value.z;
    }
    return v;
  };
  const D3 x0 = lane(&Untraced::position), way0 = lane(&Untraced::way);
  D3 x = x0, start = lane(&Untraced::start_velocity), end = lane(&Untraced::end_velocity),
     way = way0;  // of a whole step at the rate of the rest
  const L can_fly = finite(x) & finite(way) & finite(start) & finite(end);
  const bool drags = c.surface_threshold > c.threshold;
  const LinearFlow& flow = drags ? c.surface : c.air;
  D rest = all(1.0);
  L flies = can_fly;
  for (int bounce = 0; bounce < max_bounces; ++bounce) {
    const Contact contact = first_contact(scene, x, way, rest, flies);
    flies = flies & (contact.at < never);
    if (!any(flies)) break;
    const D s = only(flies, contact.at), fraction = only(rest > 0.0, s / rest);
    const D3 n = contact.normal, u = contact.surface_velocity;
    x = select(flies, fma(s, way, fma(contact.too_deep, n, x)), x);
    rest = rest - s;
    const D3 met = fma(fraction, end - start, start);
    const D kick = -(1 + c.restitution) * min(dot(n, met - u), D{});
    start = select(flies, fma(kick, n, met), start);
    D3 a = all(c.acceleration);
    if (drags) a = fma(all(c.surface_rate), u, a);
    D3 w1 = fma(rest, all(flow.keep - 1) * start + all(flow.gain) * a, start);
    D3 rest_way = all(flow.way_keep) * start + (rest * flow.way_gain) * a;
    const D sinks = dot(n, rest_way - all(c.step) * u);
    const L rests = sinks < 0.0;  // it rests, and slides
    rest_way = fma(-only(rests, sinks), n, rest_way);
    w1 = fma(-only(rests, min(dot(n, w1 - u), D{})), n, w1);
    way = select(flies, rest_way, way);
    end = select(flies, w1, end);
    if (bounce + 1 == max_bounces) {
      end = select(flies, start, end);
      rest = flies ? D{} : rest;
    }
  }
  x = fma(rest, way, x);
  const D work = dot(all(c.acceleration), x - x0 - way0);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t p = from[i].particle;
    particles.x[p] = x.x[i], particles.y[p] = x.y[i], particles.z[p] = x.z[i];
    particles.vx[p] = end.x[i], particles.vy[p] = end.y[i], particles.vz[p] = end.z[i];
    if (can_fly[i] != 0) energy[p] += 2 * (c.air.gain / c.step) * work[i];
  }
}

}  // namespace

void trace(const RuleConstants& c,
           std::span<const Placed> objects,
           LookUp kind,
           std::span<const Untraced> from,
           const ParticleSpan& particles,
           double* energy) {
  for (std::size_t first = 0; first < from.size(); first += width) {
    const std::size_t count = std::min<std::size_t>(width, from.size() - first);
    trace_vector({c, objects, kind}, from.subspan(first, count), particles, energy);
  }
}

}  // namespace tess::dn
