// Whether what a run writes at its end can be written: asked before it begins, for a run is long.
// Called by each process; process 0 alone writes.
#pragma once

#include "apps/particles/options.hpp"

namespace particles {

/// Makes the folder of --out and looks at every file that this run puts there, and at that of
/// --json. Throws Error(environment) that names the option, the path and the remedy.
void prepare_outputs(const Scene& scene, const Options& options);

}  // namespace particles
