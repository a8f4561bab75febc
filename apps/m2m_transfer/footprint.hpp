// The cost of a transfer besides time: the memory of all processes, and the bytes sent between
// them. A group with one member per PE contributes the numbers to a reduction.
#pragma once

#include "apps/m2m_transfer/names.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>

namespace m2m_transfer {

struct Footprint {
  std::uint64_t peak_memory_bytes = 0;           ///< sum of the peaks of all processes
  std::uint64_t greatest_peak_memory_bytes = 0;  ///< the largest of these peaks
  std::uint64_t bytes_sent = 0;                  ///< between processes since the start, by all PEs
};

/// Joins footprints in a reduction.
struct JoinFootprints {
  Footprint operator()(Footprint a, const Footprint& b) const;
};

class Gauge : public Group<Gauge> {
 public:
  /// Contributes the bytes that this PE sent; the first PE of a process adds the memory of the
  /// process.
  void read(Callback<Footprint> target);
};

}  // namespace m2m_transfer
