// Pictures as SVG, looked at along an axis: a cut through a field (the paper's first figure:
// distance as shade, normals as arrows), and the paths of particles around the shadow of the
// objects (figures 3, 6, 7 and 8).
#pragma once

#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/simulate.hpp"

#include <string>
#include <vector>

namespace particles {

/// The field cut at `at` on `axis` (0 … 2), in the object's own coordinates. Throws
/// Error(bad_value) for a place outside of the grid.
[[nodiscard]] std::string slice_svg(const tess::dn::Field& field, int axis, double at);

/// Paths of the particles over all snapshots, the objects where they stand at first, and the
/// outline of the moving ones where they stand at last.
[[nodiscard]] std::string paths_svg(const Scene& scene, const std::vector<Snapshot>& snapshots);

}  // namespace particles
