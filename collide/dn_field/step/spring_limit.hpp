// What keeps the spring passive where the closest surface changes within a step: in corners, past
// edges, on curved objects a particle can enter a stiff spring from the side, unnoticed by the
// plane that the step was computed with, and would find potential energy that it never paid for.
// After the step its depth is looked up again, and its speed, then its depth, cut to the energy it
// had; that again where it then stands, for a look-up may say another depth than was meant. Who
// does not come to an end so turns back: from where the step began, taken along by the surface, the
// other way about. Private to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"
#include "collide/dn_field/step/start.hpp"

namespace tess::dn {

struct SpringLimit {
  const RuleConstants& constants;
  Setting setting;
  const Closest& before;  ///< the closest surfaces when the step began
  const Start& start;
  Scratch& scratch;  ///< .energy: twice that of each particle, spring and way included

  /// after: the closest surfaces of the particles where they stand now. Whoever was put elsewhere
  /// is to be looked up again, and has paid what that took against gravity.
  Moved cut(const Closest& after, const ParticleSpan& particles) const;
  /// The last resort for those that cut() would still put elsewhere, or cannot.
  Moved put_back(const Closest& after, const ParticleSpan& particles) const;
};

}  // namespace tess::dn
