// Runs a problem on the machine: distributes the meshes, transfers the fields, and compares the
// results with the exact values where they are. Only numbers of the report come to PE 0, unless the
// problem collects its results.
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/run/footprint.hpp"
#include "runtime/runtime.hpp"

namespace m2m_transfer {

/// Fills in the reports, and if the problem collects its results the fields of the meshes that were
/// written, with an additional field "status". Destroys the chares of the meshes at the end.
/// `gauge`: a group that exists on all PEs. `progress` shows the phases.
Task measure(Problem& problem, GroupProxy<Gauge> gauge, kit::Progress& progress);

}  // namespace m2m_transfer
