#include "collide/dn_field/step/continuous_collision.hpp"

#include "collide/dn_field/path.hpp"
#include "collide/dn_field/step/pose.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

using namespace lanes;

constexpr int max_bounces = 16;
// The shortest advances, in cells: into the next voxel; for trilinear blends, below the resolution
// of the grid.
constexpr float into_next = 1e-3F, blend_stride = 0.25F;
constexpr float level = 1e-6F;      // slopes of a path below this are rounding
constexpr double most_bent = 0.25;  // cells between a path and the straight one taken for it
constexpr double never = HUGE_VAL;
// Squares of longer ways overflow: particles on them fly straight, through surfaces too.
constexpr double longest_way = 1e150;
// Of the paths of a step: a particle that sinks no faster rests on the surface, up to rounding.
constexpr double at_rest = 1e-12;

D norm1(D3 v) {
  return abs(v.x) + abs(v.y) + abs(v.z);
}

Sample sample_of(const PlacedObject& object, LookUp kind, F3 g) {
  if (kind == LookUp::trilinear) return sample<LookUp::trilinear, Ask::both>(object.field, g);
  if (kind == LookUp::nearest)
    return object.compressed ? sample<LookUp::nearest, Ask::both>(object.planes, g)
                             : sample<LookUp::nearest, Ask::both>(object.field, g);
  return object.compressed ? sample<LookUp::tangent, Ask::both>(object.planes, g)
                           : sample<LookUp::tangent, Ask::both>(object.field, g);
}

/// The fraction of `way`, in grid coordinates, that stays in the voxel of g. A slope of the size of
/// rounding would hold particles that slide on the boundary of voxels at it: it counts as none.
F way_in_voxel(F3 g, F3 way, F per_cell) {
  const auto along = [per_cell](F at, F by) {
    const F h = at + 0.5F, in = h - floor(h);
    return abs(by) * per_cell >= level ? (by > 0.0F ? 1.0F - in : in) / abs(by) : all(HUGE_VALF);
  };
  return min(min(along(g.x, way.x), along(g.y, way.y)), along(g.z, way.z));
}

/// The largest power of two that is not above v, for v > 0.
D power_of_two(D v) {
  return (D)((L)v & (L{} + 0x7FF0000000000000));
}

/// A sample of one object's field, in units of the world when the step begins.
struct Here {
  D distance;  ///< `never` outside the field
  D3 normal;   ///< unit or zero
  D stride;    ///< fraction of the step for which the sample holds, or which is free
};

/// By how much a threshold in the world grows, as seen from an object that shrinks: until it has
/// half its size, for which a Bend is valid, or until the step's end.
D grown(double threshold, const PlacedObject& object, const Pose& pose) {
  return threshold / max(0.5 * pose.size(), all(1 + object.growth)) - threshold;
}

Here sample_here(const PlacedObject& object, LookUp kind, double threshold, const Pose& pose, D3 x,
                 D3 way, const Seen& seen) {
  const F3 g = to_grid(object, to_float(seen.place - object.centre));
  const Sample found = sample_of(object, kind, g);
  const I in = found.in;
  F free = free_in_world(object, found, g);
  if (object.growth < 0) free = free - only(in, to_float(grown(threshold, object, pose)));
  free = max(free, F{});
  const D3 n = to_double(only(in, to_world(object, found.normal)));
  // The way is scaled by a power of two, exactly: floats hold neither squares above 1e38 nor the
  // fractions of such a way that a voxel is.
  const D per_size = 1.0 / max(power_of_two(norm1(seen.way)), all(0x1p-1000));
  const F3 w = turned_to_grid(object, to_float(per_size * seen.way));
  const F per_cell = 1.0F / sqrt(dot(w, w));
  const F straight = kind == LookUp::trilinear
                         ? blend_stride * per_cell
                         : (in ? way_in_voxel(g, w, per_cell) : F{}) + into_next * per_cell;
  Here here{widen(in) ? to_double(distance_in_world(object, found)) : all(never), refined(n), {}};
  if (object.bends()) {
    const Bend bend = bend_of(object, pose, x, way);
    const D held = min(per_size * to_double(straight), bend.time_within(most_bent * object.cell));
    here.stride = min(max(bend.time_for(to_double(free)), held), bend.valid);
  } else {
    here.stride = per_size * to_double(max(free / object.cell * per_cell, straight));
  }
  // So far away that floats do not hold the place.
  here.stride = norm1(to_double(g)) < never ? here.stride : all(never);
  return here;
}

struct Contact {
  D at = all(never);  ///< fraction of the step
  D3 normal{}, surface_velocity{};
  D too_deep{}, object{};  ///< its number
};
Contact select(L mask, const Contact& a, const Contact& b) {
  return {mask ? a.at : b.at, select(mask, a.normal, b.normal),
          select(mask, a.surface_velocity, b.surface_velocity), mask ? a.too_deep : b.too_deep,
          mask ? a.object : b.object};
}

/// The gap between a particle and its contact with an object, extrapolated from one sample, as seen
/// from the object.
struct Gap {
  const PlacedObject& object;
  const Here& field;
  const D3& place;
  double threshold;  ///< in the world; seen from the object it shrinks while the object grows

  [[nodiscard]] D keeps_off(const Pose& pose) const { return threshold / pose.size(); }
  [[nodiscard]] D at(const Pose& pose, const Seen& seen) const {
    return field.distance + dot(field.normal, seen.place - place) - keeps_off(pose);
  }
  [[nodiscard]] D rate(const Pose& pose, const Seen& seen) const {
    return fma(object.growth / pose.size(), keeps_off(pose), dot(field.normal, seen.way));
  }
};

struct Scene {
  const RuleConstants& constants;
  std::span<const PlacedObject> objects;
  LookUp kind;
};

/// Paths x + s × way in the world that start at the fraction `begin` of the step.
struct Ways {
  D3 x, way;
  D begin;

  [[nodiscard]] D3 at(D s) const { return fma(s, way, x); }
};

/// The contact with object `o` within the stride that its sample at s allows; `next` is reduced to
/// the end of the stride.
Contact contact_with(const Scene& scene, std::size_t o, const Ways& ways, D s, D& next) {
  const RuleConstants& c = scene.constants;
  const PlacedObject& object = scene.objects[o];
  const Pose pose(object, ways.begin + s);
  const D3 x = ways.at(s);
  const Seen seen = lanes::seen(object, pose, x, ways.way);
  const Here here = sample_here(object, scene.kind, c.threshold, pose, x, ways.way, seen);
  next = min(next, s + here.stride);
  const Gap gap{object, here, seen.place, c.threshold};
  const D closes = gap.rate(pose, seen);
  const L sinks =
      (closes < -at_rest * (norm1(ways.way) + norm1(seen.way))) & (here.distance < never);
  D met = max(gap.at(pose, seen) / -closes, D{});
  const L may = settled(sinks & (met <= 2.0 * here.stride));
  if (!any(may)) return {};
  if (object.bends())
    for (int newton = 0; newton < 2; ++newton) {
      const D after = only(may, min(met, here.stride));
      const Pose then(object, ways.begin + s + after);
      const Seen seen_then = lanes::seen(object, then, ways.at(s + after), ways.way);
      const D rate = gap.rate(then, seen_then);
      const D better = max(after - gap.at(then, seen_then) / rate, D{});
      met = (may & (rate < 0.0)) ? better : met;
    }
  // By the object's pose at the contact, so that a resting particle stays at rest.
  const L touches = may & (met <= here.stride);
  const D at = s + only(touches, met);
  const Pose then(object, ways.begin + at);
  const D3 n = then.now(here.normal);
  return {touches ? at : all(never), n, then.surface_velocity(ways.at(at), all(c.threshold) * n),
          max(c.threshold - c.slack - here.distance * then.size(), D{}),
          all(static_cast<double>(o))};
}

/// The first contacts on x + s × way, 0 <= s <= rest, from the fraction 1 − rest of the step on, of
/// particles that fly; `at` is `never` where there is none. `rest` is reduced where the path could
/// not be followed to its end.
Contact first_contact(const Scene& scene, D3 x, D3 way, D& rest, L flies) {
  std::size_t budget = 1024;  // advances; each leads into another voxel
  for (const PlacedObject& object : scene.objects)
    budget +=
        8 * static_cast<std::size_t>(object.field.n[0] + object.field.n[1] + object.field.n[2]);
  const Ways ways{x, way, 1.0 - rest};
  Contact first;
  D s{};
  for (L going = flies & (s <= rest); any(going); going = going & (s <= rest)) {
    if (budget-- == 0) {
      rest = going ? s : rest;
      break;
    }
    D next = all(never);
    Contact contact;
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const Contact here = contact_with(scene, o, ways, s, next);
      contact = select(here.at < contact.at, here, contact);
    }
    const L found = going & (contact.at <= next) & (contact.at <= rest);
    first = select(found, contact, first);
    going = going & ~found & (next < never);
    s = going ? next : all(never);
  }
  return first;
}

L finite(D3 v) {
  return norm1(v) < never;
}

/// The velocity with which particles meet a surface, and its change along the normal.
struct Collision {
  D3 met;
  D kick;
};

/// A collision at the fraction f of a straight path; the velocity goes from `start` to `end`. The
/// potential energy there is lower by f (1 - f) (end - start)² / 2 than on the parabola at the same
/// time. The velocity gets the difference: its part along the normal by that part of end - start,
/// its part along the surface by the rest. So the energy is kept, seen from the surface too.
Collision collision(const RuleConstants& c, D3 start, D3 end, D f, D3 n, D3 u) {
  const D3 gained = end - start, met = fma(f, gained, start), w = met - u;
  const D rise = dot(n, w);
  if (!c.falls) return {met, -(1 + c.restitution) * min(rise, D{})};
  const D off = f * (1.0 - f), an = dot(n, gained);
  const D3 along = fma(-an, n, gained);
  const D p = dot(along, w), q = dot(along, along), r = abs(p) + sqrt(fma(p, p, off * q * q));
  const D more = only(r > 0.0, off * q / r);
  return {fma(p < 0.0 ? -more : more, along, met),
          max(c.restitution * sqrt(fma(rise, rise, off * an * an)) - rise, D{})};
}

/// Moves particles that touch an object at the fraction f of the step with it until the step's end.
/// x: their places; slides: their velocities relative to the surface.
void take_along(const Scene& scene, const Contact& contact, L touches, D f, D3& x, D3 slides,
                D3& velocity) {
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Pose now(scene.objects[o], f), last(scene.objects[o], all(1.0));
    const L on = touches & (contact.object == static_cast<double>(o));
    x = select(on, last.place(now.seen(x)), x);
    const D3 along = last.now(now.begin(slides));
    velocity = select(on, last.surface_velocity(x, D3{}) + along, velocity);
  }
}

/// Waypoints of the particles that take_along() moves, on arcs around the object's origin.
void keep_arcs(const Scene& scene, const Contact& contact, L touches, D f, D3 x,
               std::span<const Untraced> from, Scratch& scratch) {
  if (!scratch.keeps_waypoints) return;
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (touches[i] == 0) continue;
    const std::size_t particle = from[i].particle;
    scratch.waypoints.push_back({particle, f[i], Vec3{x.x[i], x.y[i], x.z[i]}});
    const PlacedObject& object = scene.objects[static_cast<std::size_t>(contact.object[i])];
    const D3 seen = Pose(object, f).seen(x);
    const double turns = (1 - f[i]) * static_cast<double>(object.spin) / straight_turn;
    const int n = 1 + static_cast<int>(std::min(turns, most_pieces));
    for (int arc = 1; arc < n; ++arc) {
      const double part = f[i] + (1 - f[i]) * arc / n;
      const D3 at = Pose(object, all(part)).place(seen);
      scratch.waypoints.push_back({particle, part, Vec3{at.x[i], at.y[i], at.z[i]}});
    }
  }
}

/// Traces at most a vector of particles.
void trace_vector(const Scene& scene, std::span<const Untraced> from, const ParticleSpan& particles,
                  Scratch& scratch) {
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
     way = way0;  // per step
  const L can_fly = finite(x) & (norm1(way) < longest_way) & finite(start) & finite(end);
  const bool drags = c.surface_threshold > c.threshold;
  const LinearFlow& flow = drags ? c.surface : c.air;
  D rest = all(1.0);
  L flies = can_fly;
  const auto keep_waypoints = [&](L which) {
    if (!scratch.keeps_waypoints) return;
    for (std::size_t i = 0; i < from.size(); ++i)
      if (which[i] != 0)
        scratch.waypoints.push_back({from[i].particle, 1 - rest[i], Vec3{x.x[i], x.y[i], x.z[i]}});
  };
  keep_waypoints(flies);
  for (int bounce = 0; bounce < max_bounces; ++bounce) {
    const Contact contact = first_contact(scene, x, way, rest, flies);
    flies = flies & (contact.at < never);
    if (!any(flies)) break;
    const D s = only(flies, contact.at), fraction = only(rest > 0.0, s / rest);
    const D3 n = contact.normal, u = contact.surface_velocity;
    rest = rest - s;
    const auto [met, kick] = collision(c, start, end, fraction, n, u);
    start = select(flies, fma(kick, n, met), start);
    D3 a = all(c.acceleration);
    if (drags) a = fma(all(c.surface_rate), u, a);
    const D falls = max(-dot(n, a), D{});
    const L pays = flies & (contact.too_deep > 0.0) & (falls > 0.0);
    const D up = lifted(pays, contact.too_deep, falls, c.sunk, u, start);
    x = select(flies, fma(s, way, fma(up, n, x)), x);
    D3 w1 = fma(rest, all(flow.keep - 1) * start + all(flow.gain) * a, start);
    D3 rest_way = all(flow.way_keep) * start + (rest * flow.way_gain) * a;
    const D sinks = dot(n, rest_way - all(c.step) * u);
    const L rests = sinks < 0.0;  // it rests there and slides
    rest_way = fma(-only(rests, sinks), n, rest_way);
    w1 = fma(-only(rests, min(dot(n, w1 - u), D{})), n, w1);
    way = select(flies, rest_way, way);
    end = select(flies, w1, end);
    if (bounce + 1 == max_bounces) {
      keep_arcs(scene, contact, flies, 1.0 - rest, x, from, scratch);
      take_along(scene, contact, flies, 1.0 - rest, x, start - u, end);
      rest = only(~flies, rest);
    } else {
      keep_waypoints(flies);
    }
  }
  x = fma(rest, way, x);
  const D work = dot(all(c.acceleration), x - x0 - way0);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t p = from[i].particle;
    particles.x[p] = x.x[i], particles.y[p] = x.y[i], particles.z[p] = x.z[i];
    particles.vx[p] = end.x[i], particles.vy[p] = end.y[i], particles.vz[p] = end.z[i];
    if (can_fly[i] != 0) scratch.energy[p] += 2 * (c.air.gain / c.step) * work[i];
  }
}

}  // namespace

void trace(const RuleConstants& c, std::span<const PlacedObject> objects, LookUp kind,
           const ParticleSpan& particles, Scratch& scratch) {
  const std::span<const Untraced> from = scratch.untraced;
  for (std::size_t first = 0; first < from.size(); first += width) {
    const std::size_t count = std::min<std::size_t>(width, from.size() - first);
    trace_vector({c, objects, kind}, from.subspan(first, count), particles, scratch);
  }
  scratch.untraced.clear();
}

}  // namespace tess::dn
