// The correction after the rules of the surface, for particles that one voxel's plane misleads: in a
// corner, past an edge or on a curved object a particle can enter a stiff spring from the side and
// would gain potential energy. The depth is sampled again at the end of the step. A particle with
// more energy than it had loses speed; if its depth alone takes more, it returns: it is put back to
// its start, which moved with the surface, with reversed velocity relative to the surface. Private
// to the step loop.
#pragma once

#include "collide/dn_field/rules/rule_loop.hpp"

namespace tess::dn {

/// A step that is to be corrected.
struct CorrectedStep {
  const RuleConstants& constants;
  Setting setting;
  const NearestSurface& nearest;  ///< at the start of the step
  const ParticleSpan& start;      ///< the particles before the rules of the surface
  const ParticleSpan& particles;
  Scratch& scratch;  ///< energy: read; waypoints of particles that return are erased
};

/// nearest_after: the nearest surfaces at the end of the step. Returns whether a particle returned.
[[nodiscard]] bool limit_springs(const CorrectedStep& step, const NearestSurface& nearest_after);

}  // namespace tess::dn
