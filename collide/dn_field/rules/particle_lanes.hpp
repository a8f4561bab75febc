// Particles p, p + 1, … of a span, as many as a vector holds. Private to the step loop.
#pragma once

#include "collide/dn_field/geometry/lanes.hpp"
#include "collide/dn_field/particles.hpp"

namespace tess::dn::lanes {

inline D3 places(const ParticleSpan& particles, std::size_t p) {
  return load3(particles.x + p, particles.y + p, particles.z + p);
}
inline D3 velocities(const ParticleSpan& particles, std::size_t p) {
  return load3(particles.vx + p, particles.vy + p, particles.vz + p);
}
inline void set_places(const ParticleSpan& particles, std::size_t p, D3 x) {
  store(particles.x + p, x.x), store(particles.y + p, x.y), store(particles.z + p, x.z);
}
inline void set_velocities(const ParticleSpan& particles, std::size_t p, D3 v) {
  store(particles.vx + p, v.x), store(particles.vy + p, v.y), store(particles.vz + p, v.z);
}

}  // namespace tess::dn::lanes
