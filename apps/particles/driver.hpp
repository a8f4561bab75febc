// From a scene file to its table: reads, runs, and writes what was asked for. What can be wrong
// with the input is found before the run starts.
#pragma once

#include "apps/particles/simulation/simulate.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace particles {

/// As the command line gives them.
struct DriverOptions {
  std::string scene;
  std::int32_t steps = -1;  ///< instead of the scene's; -1: the scene's
  std::string json, out;
  bool explain = false;
  bool study = false;
  std::vector<int> resolutions;  ///< of the study; empty: the usual ones
  bool compressed = false;       ///< also where the scene does not say so
  RunOptions run{};
};

/// Returns the exit code. Throws tess::Error for bad input.
int drive(tess::Setup& setup, const DriverOptions& options);

}  // namespace particles
