#include "collide/dn_field/step/spring_limit.hpp"

namespace tess::dn {
namespace {

using namespace lanes;

constexpr double noise = 1e-6;  // of float distances; cut, it would eat a soft spring's energy

/// What particles p, p + 1, … have and may have: twice the energies, relative to the surface.
struct Account {
  D3 u, w;  // velocity of the surface; of the particles against it
  D depth;  // in the spring, positive
  D kinetic;
  D energy;  // that they may have in all
  D left;    // of that, for the motion
  L over;    // who has more
};

Account account(const SpringLimit& limit, const SpringConstants& spring, const Closest& after,
                const ParticleSpan& particles, std::size_t p) {
  Account a{};
  a.depth = spring.reach - to_double(load<F>(after.distance + p));
  if (limit.setting == Setting::general) a.u = surface_velocities(limit.before, p);
  a.w = velocities(particles, p) - a.u;
  a.kinetic = dot(a.w, a.w);
  a.energy = max(load<D>(limit.scratch.energy + p), D{});
  a.left = a.energy - spring.stiffness * a.depth * a.depth;
  a.over = (a.depth > 0.0) & (a.kinetic - a.left > noise * a.energy) & (a.kinetic < HUGE_VAL);
  return a;
}

/// The depth that the energy pays for.
D paid(const SpringConstants& spring, D energy) {
  return sqrt(energy * (1 / spring.stiffness));
}

}  // namespace

Moved SpringLimit::cut(const Closest& after, const ParticleSpan& span) const {
  const SpringConstants spring = constants.spring;  // copies, which no store can change
  const ParticleSpan particles = span;
  Moved moved = Moved::none;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const Account a = account(*this, spring, after, particles, p);
    if (!any(a.over)) continue;
    const D scale = sqrt(only(a.left > 0.0, a.left / a.kinetic));
    set_velocities(particles, p, select(a.over, a.u + scale * a.w, velocities(particles, p)));
    const D push = a.depth - paid(spring, a.energy);
    const L deeper = a.over & (push > 0.0);
    if (!any(deeper)) continue;
    moved = Moved::some;
    const D3 n = to_double(normals(after, p)), x = places(particles, p);
    const D square = dot(n, n);
    const L pushed = deeper & (square > 0.25);
    const D3 way = push * refined(n, square);
    set_places(particles, p, select(pushed, x + way, x));
    const D work = only(pushed, dot(all(constants.acceleration), way));
    const D energy = load<D>(scratch.energy + p);
    store(scratch.energy + p, fma(all(2 * constants.air.gain / constants.step), work, energy));
  }
  return moved;
}

Moved SpringLimit::put_back(const Closest& after, const ParticleSpan& particles) const {
  Moved moved = Moved::none;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const Account a = account(*this, constants.spring, after, particles, p);
    const L deeper = a.over & (a.depth > paid(constants.spring, a.energy));
    if (!any(deeper)) continue;
    moved = Moved::some;
    const D3 taken_along = fma(all(constants.step), a.u, start.places(p));
    set_places(particles, p, select(deeper, taken_along, places(particles, p)));
    set_velocities(particles, p,
                   select(deeper, a.u + (a.u - start.velocities(p)), velocities(particles, p)));
  }
  return moved;
}

}  // namespace tess::dn
