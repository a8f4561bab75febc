// Runs a problem on the machine: distributes both meshes, transfers the fields, gathers the result
// on PE 0, and compares it with the exact values.
#pragma once

#include "apps/m2m_transfer/footprint.hpp"
#include "apps/m2m_transfer/problem.hpp"
#include "apps/progress.hpp"
#include "runtime/runtime.hpp"

namespace m2m_transfer {

/// Fills in the target fields, with an additional field "status", and the report. Destroys the
/// chares of the meshes at the end. `gauge`: a group that exists on all PEs. `progress` shows the
/// phases.
Task measure(Problem& problem, GroupProxy<Gauge> gauge, apps::Progress& progress);

}  // namespace m2m_transfer
