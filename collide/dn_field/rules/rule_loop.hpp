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

template <Setting Where, Flight Flies, Impacts Hits>
RuleLoop chosen(Springs springs) {
  return springs == Springs::none ? &lanes::rule_loop<Flies, Hits, Springs::none, Where>
                                  : &lanes::rule_loop<Flies, Hits, Springs::exact, Where>;
}
template <Setting Where, Flight Flies>
RuleLoop chosen(Impacts impacts, Springs springs) {
  if (impacts == Impacts::none) return chosen<Where, Flies, Impacts::none>(springs);
  if (impacts == Impacts::plain) return chosen<Where, Flies, Impacts::plain>(springs);
  return chosen<Where, Flies, Impacts::swept>(springs);
}
template <Setting Where, bool Falls>
RuleLoop chosen(const LoopKey& key) {
  if (key.flight.drags == Drags::none)
    return chosen<Where, Flight{Falls}>(key.impacts, key.springs);
  if (key.flight.drags == Drags::everywhere)
    return chosen<Where, Flight{Falls, Drags::everywhere}>(key.impacts, key.springs);
  return chosen<Where, Flight{Falls, Drags::surface}>(key.impacts, key.springs);
}
template <Setting Where>
RuleLoop chosen(const LoopKey& key) {
  return key.flight.falls ? chosen<Where, true>(key) : chosen<Where, false>(key);
}

[[nodiscard]] RuleLoop rule_loop_at_rest(const LoopKey& key);
[[nodiscard]] RuleLoop rule_loop_general(const LoopKey& key);

}  // namespace tess::dn
