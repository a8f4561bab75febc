// What --reference compares with: radial basis interpolation of the same fields, on one PE.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"
#include "runtime/runtime.hpp"

namespace m2m_transfer {

/// The errors of radial basis interpolation from the source of the first pair to its target, which
/// stay where they are, and its times: `narrow` to factor, `apply` for all values. Its `kind` is
/// "radial-basis". Throws Error as RadialBasis does.
TaskOf<TransferReport> measure_reference(const Problem& problem);

}  // namespace m2m_transfer
