#include "collide/dn_field/free_loop.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

using namespace lanes;

struct Eight {
  D3 x, v;
};
Eight load_eight(const ParticleSpan& particles, std::size_t p) {
  return {load3(particles.x + p, particles.y + p, particles.z + p),
          load3(particles.vx + p, particles.vy + p, particles.vz + p)};
}
void store_places(const ParticleSpan& particles, std::size_t p, const Eight& e) {
  store(particles.x + p, e.x.x), store(particles.y + p, e.x.y), store(particles.z + p, e.x.z);
}
void store_velocities(const ParticleSpan& particles, std::size_t p, const Eight& e) {
  store(particles.vx + p, e.v.x), store(particles.vy + p, e.v.y), store(particles.vz + p, e.v.z);
}

template <Flight Flies>
void fly_one(const FlightConstants& c, Eight& e) {
  const Flown flight = flown<Flies, false>(c, e.v, D{}, D3{});
  e.x = e.x + flight.way;
  e.v = flight.v1;
}

template <Flight Flies>
void fly(const FlightConstants& constants,
         const ParticleSpan& span,
         std::span<const VelocityChanges> changes) {
  const FlightConstants c = constants;  // copies, which no store to a particle can change
  const ParticleSpan particles = span;
  const std::size_t n_steps = changes.size();
  if (std::all_of(changes.begin(), changes.end(), [](const auto& step) { return step.none(); })) {
    for (std::size_t p = 0; p < particles.count; p += width) {
      Eight e = load_eight(particles, p);
      for (std::size_t i = 0; i < n_steps; ++i) fly_one<Flies>(c, e);
      store_places(particles, p, e);
      if constexpr (Flies != Flight::none) store_velocities(particles, p, e);
    }
    return;
  }
  // A kick's root and quotient take long: the next eight are begun meanwhile, not the next step.
  for (const VelocityChanges& step : changes)
    for (std::size_t p = 0; p < particles.count; p += width) {
      Eight e = load_eight(particles, p);
      e.v = changed(step, e.x, e.v);
      fly_one<Flies>(c, e);
      store_places(particles, p, e);
      store_velocities(particles, p, e);
    }
}

}  // namespace

FreeLoop free_loop(Flight flight) {
  if (flight == Flight::none) return &fly<Flight::none>;
  return flight == Flight::fall ? &fly<Flight::fall> : &fly<Flight::air>;
}

}  // namespace tess::dn
