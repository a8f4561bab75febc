#include "collide/dn_field/rules/free_loop.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

using namespace lanes;

template <Flight Flies>
void fly_one(const FlightConstants& c, D3& x, D3& v) {
  const Flown flight = flown<Flies, false>(c, v, D{}, D3{});
  x = x + flight.way;
  v = flight.v1;
}

template <Flight Flies>
void fly(const FlightConstants& constants, const ParticleSpan& span,
         std::span<const VelocityChanges> changes) {
  const FlightConstants c = constants;  // copies, which no store to a particle can change
  const ParticleSpan particles = span;
  const std::size_t n_steps = changes.size();
  if (std::all_of(changes.begin(), changes.end(), [](const auto& step) { return step.none(); })) {
    for (std::size_t p = 0; p < particles.count; p += width) {
      D3 x = places(particles, p), v = velocities(particles, p);
      for (std::size_t i = 0; i < n_steps; ++i) fly_one<Flies>(c, x, v);
      set_places(particles, p, x);
      if constexpr (Flies != Flight{}) set_velocities(particles, p, v);
    }
    return;
  }
  // A kick's root and quotient take long: the next vector is begun meanwhile, not the next step.
  const auto fly_step = [&](const auto& change) {
    for (std::size_t p = 0; p < particles.count; p += width) {
      D3 x = places(particles, p), v = change(x, velocities(particles, p));
      fly_one<Flies>(c, x, v);
      set_places(particles, p, x);
      set_velocities(particles, p, v);
    }
  };
  for (const VelocityChanges& step : changes)
    if (step.kicks.size() == 1 && !(step.drag > 0))
      fly_step([kick = step.kicks.front()](D3 x, D3 v) { return kicked(kick, x, v); });
    else
      fly_step([&step](D3 x, D3 v) { return changed(step, x, v); });
}

}  // namespace

FreeLoop free_loop(Flight flight) {
  if (flight.drags == Drags::none) return flight.falls ? &fly<Flight{true}> : &fly<Flight{}>;
  // Where only a surface drags the same operations as there, so that a particle is not known by its
  // bits for having been looked up or not.
  return flight.falls ? &fly<Flight{true, Drags::everywhere}>
                      : &fly<Flight{false, Drags::everywhere}>;
}

}  // namespace tess::dn
