// Pictures as SVG, seen along an axis, in frames with labelled axes: a cut through a field (the
// paper's first figure: distance as shade, normals as arrows), and the paths of particles past the
// objects, coloured by time (figures 3 and 6 to 9).
#pragma once

#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/simulate.hpp"

#include <string>
#include <vector>

namespace particles {

/// The field cut at `at` on `axis` (0 … 2), in the object's own coordinates, within the grid.
[[nodiscard]] std::string slice_svg(const tess::dn::Field& field, int axis, double at);

/// Paths of the particles over all snapshots, and dots where they are at some of the times; the
/// shadows of the objects where they stand at first, and the outlines of moving ones at the last
/// snapshot. One frame per axis of scene.outputs.axes, side by side.
[[nodiscard]] std::string paths_svg(const Scene& scene, const std::vector<Snapshot>& snapshots);

}  // namespace particles
