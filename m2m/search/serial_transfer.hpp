// The whole transfer in one thread, with a search of its own: the oracle of the parallel one, and
// the way to move fields where no runtime is wanted. The answer depends on the meshes alone, bit
// for bit.
#pragma once

#include "m2m/field.hpp"
#include "m2m/interpolate/candidate.hpp"
#include "m2m/mesh.hpp"
#include "m2m/policy.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::m2m {

struct SerialReport {
  std::vector<Status> status;             ///< of every target vertex
  std::vector<GlobalId> tet;              ///< that gave it its value; -1 outside
  std::array<std::uint64_t, 4> counts{};  ///< of each Status
  std::uint64_t n_candidates = 0;         ///< pairs of tetrahedron and point whose boxes touch
};

/// Moves `source_fields` (at the source's vertices) to `target_fields`, which has one field for
/// each, of as many components, with the values that Keep keeps. Both meshes have passed
/// validate().
SerialReport transfer_serial(const TetMesh& source, std::span<const Field> source_fields,
                             const TetMesh& target, std::span<Field> target_fields,
                             const OutsidePolicy& policy);

}  // namespace tess::m2m
