// The kind of workload in which the chares are regions of space with their particles (region.hpp).
#pragma once

#include "apps/lb_lab/run/kind.hpp"

namespace lb_lab {

extern const Kind particles_kind;

}  // namespace lb_lab
