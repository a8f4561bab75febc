// Moves fields from one distributed mesh to another that overlaps it (the five steps of the ExaM2M
// slides). Call these functions in a coroutine, on one PE:
//
// Sample: tests/samples/transfer.cpp
//
//     DistributedMesh source, target;
//     const auto place = [&] {
//       source = scatter(mesh_a, {field}, 16, PartitionMethod::rcb);
//       target = scatter(mesh_b, {other}, 16, PartitionMethod::rcb);
//     };
//     co_await epoch(place);
//
//     TransferSummary summary;
//     co_await transfer(source, target, {.policy = Nearest{}}, &summary);
//
//     Future<Outcome> outcome;
//     target.workers.broadcast<&Worker::gather>(outcome.callback());
//     const Outcome all = co_await outcome;
//
// The result depends only on the two meshes and the fields: not on the number of PEs or parts, the
// voxels, or the order of messages. A mesh can be source and target of any number of transfers,
// also at the same time:
//
// Sample: tests/samples/transfer.cpp
//
//     Task first = transfer(a, b, options, nullptr);
//     Task second = transfer(a, c, options, nullptr);
//     co_await first;
//     co_await second;
//
// If one of two concurrent transfers reads the mesh that the other writes, it sees the result of
// the other completely or not at all. If both write to the same vertex, one of the two values
// remains, and it is not defined which. Await the first transfer before the second if that matters.
#pragma once

#include "m2m/parallel/scatter.hpp"
#include "m2m/parallel/worker.hpp"

#include <functional>

namespace tess::m2m {

struct TransferOptions {
  Point voxel_origin{0, 0, 0};
  Point voxel_size{1, 1, 1};
  OutsidePolicy policy = Keep{};
  /// Called with the name of each phase ("broad", "narrow", "report") when it starts; may be empty.
  std::function<void(const char*)> on_phase{};
};

/// Times and counts of one transfer. Times are wall-clock seconds on the calling PE.
struct TransferSummary {
  double broad = 0;   ///< boxes to voxels, candidate pairs to the target
  double narrow = 0;  ///< point location and interpolation
  double report = 0;  ///< vertices outside, ghosts, end
  Tally tally;        ///< of the target vertices
};

/// Moves all fields of `source` to `target`, which must have equally many components. When the task
/// is done, every target vertex has its value. `summary` may be null.
Task transfer(DistributedMesh source, DistributedMesh target, TransferOptions options,
              TransferSummary* summary);

/// A voxel size for a transfer between these meshes: about 100 source tetrahedra per voxel, and not
/// so small that cell indices exceed 32 bits. (Measured: with 30 tetrahedra a transfer takes a
/// third longer, with 200 as long.) It depends only on the meshes.
[[nodiscard]] Point suggest_voxel_size(const TetMesh& source, const TetMesh& target);

}  // namespace tess::m2m
