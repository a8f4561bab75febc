// Second pass of a step over a block of particles: the rules. It is one template; make_stepper()
// picks the instance of its scene, in which an unused rule leaves no instruction. The instances are
// compiled in two sources, one per setting, because they take long. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_step.hpp"

namespace tess::dn {

using RuleLoop = void (*)(const RuleConstants&, const ParticleSpan&, const NearestSurface&,
                          Scratch&);

namespace lanes {

template <Flight Flies, Impacts Hits, Springs Springy, Setting Where>
void rule_loop(const RuleConstants& constants, const ParticleSpan& span,
               const NearestSurface& nearest, Scratch& scratch) {
  using Step = RuleStep<Flies, Hits, Springy, Where>;
  // Copies that no store to a particle can change.
  const RuleConstants c = constants;
  const ParticleSpan particles = span;
  for (std::size_t p = 0; p < particles.count; p += width) {
    Step step{c, p, velocities(particles, p)};
    step.look(nearest);
    step.fly();
    if constexpr (Step::springs) step.follow_spring();
    bool new_velocity = !Step::bounces_alone;
    if constexpr (Step::hits_surface) {
      auto met = step.meet();
      if constexpr (Hits == Impacts::swept) {
        const L far = step.goes_far(nearest);
        if (any(far)) step.leave_to_trace(far, met.deep, particles, scratch);
        met.hits = met.hits & ~far, met.deep = met.deep & ~far;
      }
      if (any(met.hits | met.deep)) {
        step.bounce(met);
        new_velocity = true;
      }
    }
    if constexpr (Step::springs)
      store(scratch.energy + p, step.energy1 + 2.0 * (step.flight.gain * (1 / c.step)) * step.work);
    set_places(particles, p, places(particles, p) + step.way);
    if (new_velocity) set_velocities(particles, p, step.v1);
  }
}

}  // namespace lanes

/// The rules of a loop.
struct LoopKey {
  Flight flight;
  Impacts impacts = Impacts::none;
  Springs springs = Springs::none;
};

template <Setting Where>
RuleLoop chosen(const LoopKey& key) {
  return lanes::with<false, true>(key.flight.falls, [&]<bool Falls> {
    return lanes::with<Drags::none, Drags::everywhere, Drags::surface>(
        key.flight.drags, [&]<Drags Drag> {
          return lanes::with<Impacts::none, Impacts::plain, Impacts::swept>(
              key.impacts, [&]<Impacts Hits> {
                return lanes::with<Springs::none, Springs::exact>(
                    key.springs, [&]<Springs Springy>() -> RuleLoop {
                      return &lanes::rule_loop<Flight{Falls, Drag}, Hits, Springy, Where>;
                    });
              });
        });
  });
}

[[nodiscard]] RuleLoop rule_loop_at_rest(const LoopKey& key);
[[nodiscard]] RuleLoop rule_loop_general(const LoopKey& key);

}  // namespace tess::dn
