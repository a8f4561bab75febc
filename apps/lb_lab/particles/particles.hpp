// The kind of workload whose chares are regions of space with the particles in them (region.hpp).
#pragma once

#include "apps/lb_lab/run/kind.hpp"

namespace lb_lab {

extern const Kind particles_kind;

}  // namespace lb_lab
