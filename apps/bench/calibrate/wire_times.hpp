// What messages between the two PEs of a machine take, real or simulated: the figures from which
// the parameters of a simulated machine are found.
#pragma once

#include "runtime/task.hpp"

#include <cstddef>
#include <cstdint>

namespace bench {

/// The size of the vector of WireTimes::large.
inline constexpr std::size_t large_bytes = std::size_t{1} << 18U;
/// The size of the vector of WireTimes::exchange_packed: small enough to be packed.
inline constexpr std::size_t packed_bytes = std::size_t{1} << 13U;

/// Nanoseconds; medians.
struct WireTimes {
  double ping = 0;  ///< a number, one way, when both PEs do nothing else
  /// A vector of large_bytes, one way; 0 within a process, where it is a pointer.
  double large = 0;
  double exchange = 0;  ///< what sending a message and receiving one adds to the work of a busy PE
  double exchange_packed = 0;  ///< the same with vectors of packed_bytes; 0 within a process
};

struct WireEffort {
  std::int32_t n_samples = 15;
  std::int32_t n_rounds = 1000;  ///< of a sample; a multiple of 10
};

/// The main coroutine of a run on two PEs.
tess::Task measure_wire(WireEffort effort, WireTimes& result);

}  // namespace bench
