// The kind of workload in which the chares are blocks of cells (worker.hpp).
#pragma once

#include "apps/lb_lab/run/kind.hpp"

namespace lb_lab {

extern const Kind cells_kind;

}  // namespace lb_lab
