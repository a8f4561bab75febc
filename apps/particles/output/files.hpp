// The files that a run writes to the folder of --out, and whether they can be written: checked
// before the run begins, since a run is long. Process 0 writes, all processes check.
#pragma once

#include "apps/kit/output/file_names.hpp"
#include "apps/particles/options.hpp"
#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/simulate.hpp"

#include <string>
#include <vector>

namespace particles {

/// Checks the files that a run or a study will write to the folder of --out, which is there. None
/// replaces one of `names` (those of the driver), to which this adds what the scene reads. Throws
/// Error that names the option, the path and the remedy.
void prepare_files(const Scene& scene, const Options& options, kit::FileNames& names);

/// The points of a snapshot with their ids and velocities, as the text of a VTP file for ParaView,
/// in ASCII: the traced particles are few.
[[nodiscard]] std::string vtp(const Snapshot& snapshot);

// Pictures as SVG, seen along an axis, in frames with labelled axes.

/// A field cut at `at` on `axis` (0 … 2), in the object's own coordinates, within the grid:
/// distance as shade, normals as arrows (the paper's first figure).
[[nodiscard]] std::string slice_svg(const tess::dn::Field& field, int axis, double at);

/// Paths of the particles over all snapshots, coloured by time (figures 3 and 6 to 9), and dots
/// where they are at some of the times; the shadows of the objects where they stand at first, and
/// the outlines of moving ones at the last snapshot. One frame per axis of scene.outputs.axes, side by
/// side.
[[nodiscard]] std::string paths_svg(const Scene& scene, const std::vector<Snapshot>& snapshots);

/// Fields, trajectories and pictures, as the scene asks for them.
void write_files(const std::string& folder, const Stage& stage, const RunResult& result);

}  // namespace particles
