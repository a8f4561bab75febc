// From a scene file to its table: reads the scene, runs it, and writes what the options ask for.
// Bad input is reported before the run starts.
#pragma once

#include "apps/particles/options.hpp"
#include "runtime/runtime.hpp"

namespace particles {

/// Returns the exit code. Throws tess::Error for bad input.
int drive(tess::Setup& setup, const Options& options);

}  // namespace particles
