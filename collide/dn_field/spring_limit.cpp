#include "collide/dn_field/spring_limit.hpp"

namespace tess::dn {

using namespace lanes;

Moved limit_spring(const SpringConstants& constants,
                   Setting setting,
                   const ParticleSpan& span,
                   const Closest& before,
                   const Closest& after,
                   const Scratch& scratch) {
  constexpr double noise = 1e-6;  // of float distances; cut, it would eat a soft spring's energy
  const SpringConstants spring = constants;  // copies, which no store to a particle can change
  const ParticleSpan particles = span;
  Moved moved = Moved::none;
  for (std::size_t p = 0; p < particles.count; p += width) {
    const D depth = spring.reach - to_double(load<F>(after.distance + p));
    D3 u{};
    if (setting == Setting::general) u = surface_velocities(before, p);
    const D3 v = velocities(particles, p), w = v - u;
    const D energy = max(load<D>(scratch.energy + p), D{});
    const D kinetic = dot(w, w), left = energy - spring.stiffness * depth * depth;
    L over = (depth > 0.0) & (kinetic - left > noise * energy) & (kinetic < HUGE_VAL);
    const D3 n = to_double(normals(after, p));
    const D square = dot(n, n);
    over = over & (square > 0.25);
    const D scale = sqrt(only(left > 0.0, left / kinetic));
    const D3 slowed = select(over, u + scale * w, v);
    set_velocities(particles, p, slowed);
    const D paid = sqrt(energy * (1 / spring.stiffness));
    const L deeper = over & (depth > paid);
    if (!any(deeper)) continue;
    moved = Moved::some;
    const D push = depth - paid;
    const D3 x = places(particles, p);
    const D3 pushed = select(deeper, fma(push, refined(n, square), x), x);
    set_places(particles, p, pushed);
  }
  return moved;
}

}  // namespace tess::dn
