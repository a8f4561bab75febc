#include "collide/dn_field/rules/flight.hpp"

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
  const FlightConstants c = constants;  // copies that no store to a particle can change
  const ParticleSpan particles = span;
  const std::size_t n_steps = changes.size();
  if (std::ranges::all_of(changes, &VelocityChanges::none)) {
    for (std::size_t p = 0; p < particles.count; p += width) {
      D3 x = places(particles, p), v = velocities(particles, p);
      for (std::size_t i = 0; i < n_steps; ++i) fly_one<Flies>(c, x, v);
      set_places(particles, p, x);
      if constexpr (Flies != Flight{}) set_velocities(particles, p, v);
    }
    return;
  }
  // Roots and quotients have long latencies: the loop over particles is the inner one, so that
  // those of neighbouring vectors overlap.
  const auto fly_step = [&](const auto& before, const auto& after) {
    for (std::size_t p = 0; p < particles.count; p += width) {
      D3 x = places(particles, p), v = before(x, velocities(particles, p));
      fly_one<Flies>(c, x, v);
      set_places(particles, p, x);
      set_velocities(particles, p, after(v));
    }
  };
  const auto as_it_is = [](D3 v) { return v; };
  for (const VelocityChanges& step : changes)
    if (step.drag > 0)
      fly_step([&step](D3 x, D3 v) { return changed_before(step, x, v); },
               [drag = step.drag](D3 v) { return last_velocity(drag, v); });
    else if (step.kicks.size() == 1)
      fly_step([kick = step.kicks.front()](D3 x, D3 v) { return kicked(kick, x, v); }, as_it_is);
    else
      fly_step([&step](D3 x, D3 v) { return changed_before(step, x, v); }, as_it_is);
}

}  // namespace

FreeLoop free_loop(Flight flight) {
  if (flight.drags == Drags::none) return flight.falls ? &fly<Flight{true}> : &fly<Flight{}>;
  // The same operations also where only a surface drags: the result must not depend on whether a
  // particle was taken as near the surface.
  return flight.falls ? &fly<Flight{true, Drags::everywhere}>
                      : &fly<Flight{false, Drags::everywhere}>;
}

VelocityChanges velocity_changes(const Rules& rules, double time, double step) {
  VelocityChanges changes;
  for (const Explosion& explosion : rules.explosions) {
    const double active = std::min(time + step, explosion.start + explosion.duration) -
                          std::max(time, explosion.start);
    if (active > 0)
      changes.kicks.push_back(
          {explosion.centre, explosion.strength * active, 1 / explosion.radius});
  }
  if (rules.air_drag && rules.air_drag->law == DragLaw::quadratic)
    changes.drag = rules.air_drag->rate * step;
  return changes;
}

void change_velocities_before(const VelocityChanges& changes, const ParticleSpan& span) {
  if (changes.none()) return;
  const ParticleSpan particles = span;  // a copy that no store can change
  for (std::size_t p = 0; p < particles.count; p += width)
    set_velocities(particles, p,
                   changed_before(changes, places(particles, p), velocities(particles, p)));
}

void change_velocities_after(const VelocityChanges& changes, const ParticleSpan& span) {
  if (!(changes.drag > 0)) return;
  const ParticleSpan particles = span;
  for (std::size_t p = 0; p < particles.count; p += width)
    set_velocities(particles, p, last_velocity(changes.drag, velocities(particles, p)));
}

}  // namespace tess::dn
