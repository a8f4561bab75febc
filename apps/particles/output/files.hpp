// The files that a run writes to the folder of --out, and whether they can be written: checked
// before the run begins, since a run is long. Process 0 writes, all processes check.
#pragma once

#include "apps/particles/options.hpp"
#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/simulate.hpp"

#include <string>

namespace particles {

/// Makes the folder of --out, and checks the files that this run will write there and that of
/// --json; no file replaces another, `trace` (that of --trace), or one that the scene reads. Throws
/// Error that names the option, the path and the remedy.
void prepare_files(const Scene& scene, const Options& options, const std::string& trace);

/// The points of a snapshot with their ids and velocities, as the text of a VTP file for ParaView,
/// in ASCII: the traced particles are few.
[[nodiscard]] std::string vtp(const Snapshot& snapshot);

/// Fields, trajectories and pictures, as the scene asks for them.
void write_files(const std::string& folder, const Stage& stage, const RunResult& result);

}  // namespace particles
