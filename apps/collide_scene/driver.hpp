// From the options to the table and the files: loads the scene, collides it step by step, and
// writes what the options ask for. Bad input is reported before the run starts.
#pragma once

#include "apps/collide_scene/options.hpp"
#include "runtime/runtime.hpp"

namespace collide_scene {

/// Returns the exit code. Throws tess::Error for bad input. `on_chares`: the machine's PEs are
/// used; otherwise one thread, without the runtime.
int drive(tess::Setup& setup, const Options& options, bool on_chares);

}  // namespace collide_scene
