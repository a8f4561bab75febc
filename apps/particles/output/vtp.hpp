// Trajectories for ParaView: one VTP file of points per snapshot, and a .pvd file that lists them
// by time. ASCII: the traced particles are few.
#pragma once

#include "apps/particles/simulation/simulate.hpp"

#include <string>
#include <vector>

namespace particles {

/// The points of a snapshot with their ids and velocities, as the text of a VTP file.
[[nodiscard]] std::string vtp(const Snapshot& snapshot);

/// Writes FOLDER/trajectories.pvd and FOLDER/trajectories/step_N.vtp. Throws tess::Error that names
/// the file that cannot be written.
void write_series(const std::string& folder, const std::vector<Snapshot>& snapshots, double dt);

}  // namespace particles
