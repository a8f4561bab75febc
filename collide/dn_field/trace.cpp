#include "collide/dn_field/trace.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

constexpr int max_bounces = 16;
constexpr double stride_cells = 0.25;  // the shortest advance; thinner than what a grid resolves

/// What one object's field says at one point, in world units.
struct Here {
  double distance, free;
  Vec3 normal;
};

Here ask(const Placed& object, LookUp kind, Vec3 p) {
  using namespace lanes;
  const Vec3 from = p - object.centre;
  const auto grid = [&](int i) {
    const auto& row = object.to_grid[i];
    return static_cast<float>(from.x) * row[0] + static_cast<float>(from.y) * row[1] +
           static_cast<float>(from.z) * row[2] + object.middle[i];
  };
  const float gx = grid(0), gy = grid(1), gz = grid(2);
  const F3 g{all(gx), all(gy), all(gz)};
  Sample found{};
  if (kind == LookUp::nearest)
    found = object.compressed ? sample<LookUp::nearest, Ask::both>(object.planes, g)
                              : sample<LookUp::nearest, Ask::both>(object.field, g);
  if (kind == LookUp::tangent)
    found = object.compressed ? sample<LookUp::tangent, Ask::both>(object.planes, g)
                              : sample<LookUp::tangent, Ask::both>(object.field, g);
  if (kind == LookUp::trilinear) found = sample<LookUp::trilinear, Ask::both>(object.field, g);
  if (!(found.distance[0] < out_of_reach)) {
    const auto beyond = [](float at, int n) {
      return std::max({-at, at - static_cast<float>(n - 1), 0.0F});
    };
    const auto& n = object.field.n;
    const float outside =
        object.cell * std::max({beyond(gx, n[0]), beyond(gy, n[1]), beyond(gz, n[2])});
    return {HUGE_VAL, static_cast<double>(outside), {}};
  }
  const auto& r = object.to_world;
  const float nx = found.normal.x[0], ny = found.normal.y[0], nz = found.normal.z[0];
  const Vec3 normal{static_cast<double>(nx * r[0][0] + ny * r[0][1] + nz * r[0][2]),
                    static_cast<double>(nx * r[1][0] + ny * r[1][1] + nz * r[1][2]),
                    static_cast<double>(nx * r[2][0] + ny * r[2][1] + nz * r[2][2])};
  return {static_cast<double>(found.distance[0] * object.scale - object.padding),
          static_cast<double>(found.voxel[0] * object.scale - object.doubt),
          direction(normal)};
}

struct Contact {
  double at = HUGE_VAL;  ///< fraction of the step
  Vec3 normal, surface_velocity;
  double too_deep = 0;
};

/// A straight way in the world as seen from an object, at the size it has when the step begins: a
/// straight way, too, which a growing object sees slow down. Fractions f of the step and of that
/// way, t, are the same without growth; else t = f/(1 + f g), where 1 + f g is the scale at f over
/// that at the begin.
struct Seen {
  Vec3 from, way;
  double growth;

  [[nodiscard]] double size(double f) const { return 1 + f * growth; }
  [[nodiscard]] double seen(double f) const { return f / size(f); }
  [[nodiscard]] double in_step(double t) const {
    return t * growth < 1 ? t / (1 - t * growth) : HUGE_VAL;
  }
};

/// `x`: where the particle is after the fraction `elapsed` of the step, and flies by `way` a step.
Seen seen_from(const Placed& object, double step, Vec3 x, Vec3 way, double elapsed) {
  const Frame& frame = object.frame;
  const Vec3 from = x - elapsed * way;
  Vec3 seen = way - step * (frame.velocity + cross(frame.angular_velocity, x - frame.position));
  if (object.growth != 0) seen = seen - object.growth * (from - frame.position);
  return {from, seen, object.growth};
}

/// The first contact on x + s × way, 0 <= s <= rest, from the fraction 1 − rest of the step on;
/// `at` is HUGE_VAL where there is none. `rest` is shortened where the way could not be followed to
/// its end.
Contact first_contact(const RuleConstants& c,
                      std::span<const Placed> objects,
                      LookUp kind,
                      Vec3 x,
                      Vec3 way,
                      double& rest) {
  std::size_t budget = 1024;  // advances; each is a quarter of a voxel at least
  for (const Placed& object : objects)
    budget +=
        8 * static_cast<std::size_t>(object.field.n[0] + object.field.n[1] + object.field.n[2]);
  const double elapsed = 1 - rest;
  double s = 0;
  while (s <= rest) {
    if (budget-- == 0) {
      rest = s;
      return {};
    }
    double next = HUGE_VAL;
    Contact contact;
    for (const Placed& object : objects) {
      const Seen seen = seen_from(object, c.step, x, way, elapsed);
      const double length = norm(seen.way);
      if (!(length > 0)) continue;
      const double t = seen.seen(elapsed + s), size = seen.size(elapsed + s);
      const Vec3 p = seen.from + t * seen.way;
      const Here here = ask(object, kind, p);
      const auto cell = static_cast<double>(object.cell);
      const double stride = std::max(here.free, stride_cells * cell) / length;
      next = std::min(next, seen.in_step(t + stride) - elapsed);
      const double rise = dot(here.normal, seen.way);
      if (!(rise < 0) || !(here.distance < HUGE_VAL)) continue;
      // Both sides of a sheet look alike: turn back before it is as close as the look-up errs.
      const double threshold =
          object.two_sided
              ? std::max(c.threshold / size, cell - static_cast<double>(object.padding))
              : c.threshold / size;
      const double met = t + std::max(0.0, (here.distance - threshold) / -rise);
      const double at = seen.in_step(met) - elapsed;
      if (met <= t + stride && at < contact.at) {
        const Vec3 surface =
            object.growth != 0 ? seen.from + met * seen.way - threshold * here.normal : p;
        contact = {at,
                   here.normal,
                   object.frame.velocity_at(surface),
                   std::max(0.0, c.threshold - c.slack - here.distance * size)};
      }
    }
    if (contact.at <= next && contact.at <= rest) return contact;
    if (!(next < HUGE_VAL)) return {};
    s = next;
  }
  return {};
}

}  // namespace

double trace(const RuleConstants& c,
             std::span<const Placed> objects,
             LookUp kind,
             const Untraced& from,
             const ParticleSpan& particles) {
  Vec3 x = from.position, start = from.start_velocity, end = from.end_velocity,
       way = from.way;  // of a whole step at the rate of the rest
  const bool can_fly = is_finite(x) && is_finite(way) && is_finite(start) && is_finite(end);
  double rest = 1;
  for (int bounce = 0; can_fly; ++bounce) {
    const Contact contact = first_contact(c, objects, kind, x, way, rest);
    if (!(contact.at < HUGE_VAL)) break;
    const double s = contact.at, fraction = rest > 0 ? s / rest : 0;
    const Vec3 n = contact.normal, u = contact.surface_velocity;
    const Vec3 met = start + fraction * (end - start);
    x += s * way + contact.too_deep * n;
    rest -= s;
    const double falls = dot(n, met - u);
    start = falls < 0 ? met - ((1 + c.restitution) * falls) * n : met;
    const LinearFlow& flow = c.surface_threshold > c.threshold ? c.surface : c.air;
    Vec3 a = c.acceleration;
    if (c.surface_threshold > c.threshold) a += c.surface_rate * u;
    end = start + rest * ((flow.keep - 1) * start + flow.gain * a);
    way = flow.way_keep * start + (rest * flow.way_gain) * a;
    if (const double sinks = dot(n, way - c.step * u); sinks < 0) {  // it rests, and slides
      way = way - sinks * n;
      end = end - std::min(0.0, dot(n, end - u)) * n;
    }
    if (bounce + 1 == max_bounces) {
      end = start;
      rest = 0;
      break;
    }
  }
  x += rest * way;
  const std::size_t p = from.particle;
  particles.x[p] = x.x, particles.y[p] = x.y, particles.z[p] = x.z;
  particles.vx[p] = end.x, particles.vy[p] = end.y, particles.vz[p] = end.z;
  const Vec3 aside = x - from.position - from.way;
  return can_fly ? 2 * (c.air.gain / c.step) * dot(c.acceleration, aside) : 0;
}

}  // namespace tess::dn
