// The PE that the calling code runs on, and the machine that it belongs to. Not for code outside a
// run.
#pragma once

#include "runtime/scheduler/pe.hpp"

namespace tess {

/// The PE of the calling code.
[[nodiscard]] inline PeId my_pe() {
  return current_pe().id();
}
/// The number of PEs of the job; they are numbered from 0.
[[nodiscard]] inline std::int32_t n_pes() {
  return current_pe().n_pes();
}
/// Time since the machine started: wall clock, or the virtual clock of this PE.
[[nodiscard]] inline Time now() {
  return current_pe().now();
}
/// The machine of this run: processes, virtual time or not, a line of text.
[[nodiscard]] inline const Machine& machine() {
  return current_pe().machine();
}
/// The counters of this PE since the start.
[[nodiscard]] inline const detail::PeStatistics& statistics() {
  return current_pe().statistics();
}

}  // namespace tess
