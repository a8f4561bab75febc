// Writes a distributed mesh with its values as parallel VTU, for ParaView and VTK: each part writes
// a file of its own where it is, and no PE gathers anything.
#pragma once

#include "m2m/mesh/workers/scatter.hpp"

#include <string>
#include <vector>

namespace tess::m2m {

/// Writes `path`, "r.pvtu", which names the files beside it: "r.0.vtu", "r.1.vtu", …, one per part.
/// All processes see the folder. `names`: of the fields, which have one component each; "status" is
/// added, 0 inside to 3 outside, from the last transfer into the mesh. A point is in the file of
/// each part that uses it, with the same values. What XML cannot hold of a field's name becomes
/// U+FFFD (runtime/core/escape.hpp). No transfer of the mesh is running. Throws Error (bad_argument)
/// if there are not as many names as components, if a name is empty, "status" or then given twice,
/// if the path does not end in .pvtu, or if XML cannot hold the name of the file, (bad_file) with
/// the path if it cannot be written; a part that cannot be written ends the job with that.
Task write_pvtu(std::string path, DistributedMesh mesh, std::vector<std::string> names);

}  // namespace tess::m2m
