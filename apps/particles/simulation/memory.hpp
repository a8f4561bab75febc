// What a scene needs at least, beside what there is: a run that no memory holds is refused before
// it begins, not where it ends.
#pragma once

#include "apps/particles/scene/scene.hpp"

namespace particles {

/// Of the fields, flat, while they are built; each process builds all of them. Throws
/// Error(environment).
void check_field_memory(const Scene& scene);

/// Of fields, of the particles, which `n_processes` share, and of what process 0 gathers: rows of
/// statistics and trajectories. Throws Error(environment).
void check_memory(const Scene& scene, int n_processes);

}  // namespace particles
