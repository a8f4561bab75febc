// The PE that the calling code runs on, and the machine that it belongs to. Code outside a run
// must not call these.
#pragma once

#include "runtime/core/duration.hpp"
#include "runtime/pe/pe.hpp"

#include <cstddef>

namespace tess {

/// The PE of the calling code.
[[nodiscard]] inline PeId my_pe() {
  return current_pe().id();
}
/// The number of PEs of the job; they are numbered from 0.
[[nodiscard]] inline std::int32_t n_pes() {
  return current_pe().n_pes();
}
/// The epoch of the calling code: it is not done before all that this code causes (epoch.hpp).
[[nodiscard]] inline EpochId my_epoch() {
  return current_pe().context().epoch;
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
/// How long this PE has run messages, up to the last time that it looked into its queue (the
/// running message is not included). The first call on a PE starts the measurement, which then
/// costs two readings of a clock per look; a balancer, a trace or --stats may have started it
/// before. So only the difference of two calls has a meaning. Time in which another thread used the
/// core is subtracted, to about a millisecond; on the simulated machine the clock is virtual.
[[nodiscard]] inline Time busy_time() {
  const detail::Meter& meter = current_pe().measuring().start_meter();
  return std::chrono::round<Time>(std::chrono::duration<double>(meter.seconds(meter.busy())));
}
/// The number of arrays and groups that this PE knows: those that were created and have not been
/// freed by destroy() here.
[[nodiscard]] inline std::size_t n_collections() {
  return current_pe().collections().all().size();
}

}  // namespace tess
