// What a transfer costs besides time, over all processes and PEs: memory and bytes between
// processes. A member of a group on each PE gives its part to a reduction.
#pragma once

#include "runtime/runtime.hpp"

#include <cstdint>

namespace tess::m2m {

struct Footprint {
  std::uint64_t peak_memory_bytes = 0;           ///< sum over processes of the most each held
  std::uint64_t greatest_peak_memory_bytes = 0;  ///< of one process
  std::uint64_t bytes_sent = 0;                  ///< between processes since the start, by all PEs
};

/// For reductions.
struct JoinFootprints {
  Footprint operator()(Footprint a, const Footprint& b) const;
};

class Meter : public Group<Meter> {
 public:
  /// Gives what this PE sent, and on the first PE of a process what the process holds.
  void read(Callback<Footprint> target);
};

}  // namespace tess::m2m
