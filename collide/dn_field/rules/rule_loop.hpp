// Second pass of a step over a block of particles: the rules. One template; make_stepper() picks
// the instance of its scene from a table, in which a rule that the scene has not got left no
// instruction. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_step.hpp"

namespace tess::dn {

using RuleLoop = void (*)(const RuleConstants&, const ParticleSpan&, const Closest&, Scratch&);

namespace lanes {

template <Flight Flies, Impacts Hits, Springs Springy, Setting Where>
void rule_loop(const RuleConstants& constants, const ParticleSpan& span, const Closest& closest,
               Scratch& scratch) {
  using Step = RuleStep<Flies, Hits, Springy, Where>;
  // Copies, which no store to a particle can change.
  const RuleConstants c = constants;
  const ParticleSpan particles = span;
  for (std::size_t p = 0; p < particles.count; p += width) {
    Step step{c, p, velocities(particles, p)};
    step.look(closest);
    step.fly();
    if constexpr (Step::springs) step.follow_spring();
    bool new_velocity = !Step::bounces_alone;
    if constexpr (Step::hits_surface) {
      auto met = step.meet();
      if constexpr (Hits == Impacts::swept) {
        const L far = step.goes_far(closest);
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
}  // namespace tess::dn
