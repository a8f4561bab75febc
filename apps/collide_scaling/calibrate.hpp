// Fits the costs of a step's parts on one PE, and checks what they predict. One real PE runs steps
// of scenes in which the parts have different shares: the study's; with two replies per pair; with
// fewer pairs; with none; and with planes so far apart that they are only gridded. (Of a crowd the
// last three have smaller or larger voxels.) The fitted costs account for the measured time without
// that of the messages. Boxes are copied, and records compared, only if there are several PEs, so
// these two parts are timed by themselves.
#pragma once

#include "apps/collide_scaling/case.hpp"

#include <optional>

namespace collide_scaling {

/// The size that one PE chooses for its voxels.
[[nodiscard]] double chosen_voxel_size(const Case& given);

/// Sets given.costs. Then compares predictions for one PE and for two with measured steps, and
/// prints both. The two PEs are in this process, or if mpirun started two processes, in these.
/// Returns whether the predictions are close to what was measured; nothing in the second process.
[[nodiscard]] std::optional<bool> calibrate(Case& given, int& argc, char**& argv);

}  // namespace collide_scaling
