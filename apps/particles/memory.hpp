// What a scene needs at least, beside what there is: a run that no memory holds is refused before
// it begins, not where it ends.
#pragma once

#include "apps/particles/scene.hpp"

namespace particles {

/// Bytes that this process may have: the machine's memory, or less where the shell limits it.
[[nodiscard]] double usable_memory();

/// Of the fields, flat; each process builds all of them. Throws Error(environment).
void check_field_memory(const Scene& scene);

/// Of fields, of the particles, which `n_processes` share, and of what process 0 gathers: rows of
/// statistics and trajectories. Throws Error(environment).
void check_memory(const Scene& scene, int n_processes);

}  // namespace particles
