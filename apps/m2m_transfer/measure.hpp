// Runs a problem on the machine: sets both meshes up, transfers, gathers the result to PE 0, and
// judges it against the truth.
#pragma once

#include "apps/m2m_transfer/footprint.hpp"
#include "apps/m2m_transfer/problem.hpp"
#include "apps/progress.hpp"
#include "runtime/runtime.hpp"

namespace tess::m2m {

/// Fills in the target's fields (with one more, "status") and the report. The meshes' chares are
/// gone when it is done. `gauge`: created before, known everywhere. `progress` is told the phases.
Task measure(Problem& problem, GroupProxy<Gauge> gauge, apps::Progress& progress);

}  // namespace tess::m2m
