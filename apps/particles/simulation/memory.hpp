// The least memory that a scene needs. A run that cannot fit is refused before it begins.
#pragma once

#include "apps/particles/scene/scene.hpp"

namespace particles {

/// Adds up the fields, flat, of which each process builds all; the particles, which `n_processes`
/// share; and the rows and trajectories that process 0 gathers. Throws Error(environment) that
/// names the first key at which the sum is more than this process may have.
void check_memory(const Scene& scene, int n_processes);

}  // namespace particles
