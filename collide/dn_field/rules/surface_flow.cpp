#include "collide/dn_field/rules/surface_flow.hpp"

namespace tess::dn {
using namespace lanes;

void turn_to_surface(const FlowConstants& flow, Setting setting, const ParticleSpan& particles,
                     const NearestSurface& nearest) {
  if (setting == Setting::general)
    flow_loop<Setting::general>(flow, particles, nearest);
  else
    flow_loop<Setting::one_at_rest>(flow, particles, nearest);
}

}  // namespace tess::dn
