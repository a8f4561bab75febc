// Moving fields from one distributed mesh to another that overlaps it (the five steps of the ExaM2M
// slides).
//
//     DistributedMesh source = scatter(mesh_a, {field}, 16, PartitionMethod::rcb), target = …;
//     inside an epoch TransferTimes times; co_await transfer(source, target, {.policy = Nearest{}},
//     &times); tess::Future<Outcome> outcome;
//     target.workers.broadcast<&Worker::gather>(outcome.callback());
//     const Outcome all = co_await outcome;
//
// The answer depends on the two meshes and fields alone: not on PEs, parts, voxel size, origin or
// any order.
#pragma once

#include "m2m/parallel/scatter.hpp"
#include "m2m/parallel/worker.hpp"

#include <array>
#include <functional>

namespace tess::m2m {

struct TransferOptions {
  Point voxel_origin{0, 0, 0};
  Point voxel_size{1, 1, 1};
  OutsidePolicy policy = Keep{};
  /// Told the name of each phase ("broad", "narrow", "report") when it starts; may be empty.
  std::function<void(const char*)> on_phase{};
};

/// Wall-clock seconds of the phases, measured on the PE that runs the transfer.
struct TransferTimes {
  double broad = 0;   ///< boxes to voxels, candidates to the target's Workers
  double narrow = 0;  ///< questions and answers
  double report = 0;  ///< what lies outside
};

/// Moves all fields of `source` to `target`; awaited, it is done when every target vertex has its
/// value. `times` may be null. Both have equally many components.
Task transfer(DistributedMesh source,
              DistributedMesh target,
              TransferOptions options,
              TransferTimes* times);

/// A voxel size for a transfer between these meshes: about 100 source tetrahedra a voxel (measured:
/// 30 costs a third more, 200 no less), and not more than the bound on the number of voxels that a
/// coordinate can name. Depends on the meshes alone.
[[nodiscard]] Point suggest_voxel_size(const TetMesh& source, const TetMesh& target);

}  // namespace tess::m2m
