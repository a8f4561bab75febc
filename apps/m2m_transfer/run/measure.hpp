// Runs a problem on the machine: distributes the meshes, transfers the fields, and compares the
// results with the exact values where they are. Only numbers of the report come to PE 0, unless the
// problem collects its results.
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "runtime/runtime.hpp"

namespace m2m_transfer {

/// Joins footprints in a reduction.
struct JoinFootprints {
  Footprint operator()(Footprint a, const Footprint& b) const;
};

/// The memory of all processes, and the bytes sent between them: a member per PE contributes the
/// numbers to a reduction.
class Gauge : public Group<Gauge> {
 public:
  /// Contributes the bytes that this PE sent; the first PE of a process adds the memory of the
  /// process.
  void read(Callback<Footprint> target);
};

/// Fills in the reports, and if the problem collects its results the fields of the meshes that were
/// written, with an additional field "status". Destroys the chares of the meshes at the end.
/// `gauge`: a group that exists on all PEs. `progress` shows the phases.
Task measure(Problem& problem, GroupProxy<Gauge> gauge, kit::Progress& progress);

}  // namespace m2m_transfer
