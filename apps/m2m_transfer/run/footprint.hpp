// The memory of all processes, and the bytes sent between them. A group with one member per PE
// contributes the numbers to a reduction.
#pragma once

#include "apps/m2m_transfer/report.hpp"
#include "runtime/runtime.hpp"

namespace m2m_transfer {

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
