// Runs a problem on the machine: distributes the meshes, transfers the fields, gathers the results
// on PE 0, and compares them with the exact values.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/run/footprint.hpp"
#include "apps/progress.hpp"
#include "runtime/runtime.hpp"

namespace m2m_transfer {

/// Fills in the fields of the meshes that were written, with an additional field "status", and the
/// reports. Destroys the chares of the meshes at the end. `gauge`: a group that exists on all PEs.
/// `progress` shows the phases.
Task measure(Problem& problem, GroupProxy<Gauge> gauge, apps::Progress& progress);

}  // namespace m2m_transfer
