// A transfer in one thread, with a search of its own: the oracle of the parallel transfer. The
// result depends only on the meshes, bit for bit.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh.hpp"
#include "m2m/policy.hpp"
#include "m2m/status.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tess::test {

struct SerialReport {
  std::vector<m2m::Status> status;        ///< per target vertex
  std::vector<m2m::GlobalId> tet;         ///< per target vertex: its tetrahedron; -1 outside
  std::array<std::uint64_t, 4> counts{};  ///< per Status
  std::uint64_t n_candidates = 0;         ///< pairs of tetrahedron and point whose boxes touch
};

/// Moves `source_fields` to `target_fields`, which has a field with the same number of components
/// for each of them; its values are those that the policy Keep leaves. Both meshes have passed
/// validate().
SerialReport transfer_serial(const m2m::TetMesh& source, std::span<const m2m::Field> source_fields,
                             const m2m::TetMesh& target, std::span<m2m::Field> target_fields,
                             const m2m::OutsidePolicy& policy);

}  // namespace tess::test
