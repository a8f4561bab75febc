// Moving fields from one distributed mesh to another that overlaps it (the five steps of the ExaM2M
// slides).
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
// The answer depends on the two meshes and fields alone: not on PEs, parts, voxel size, origin or
// any order. A mesh may be source and target of any number of transfers, also of several at once:
//
//     Task first = transfer(a, b, …), second = transfer(a, c, …);
//     co_await first;
//     co_await second;
//
// Of transfers that run at once, one that reads what another one writes reads it wholly or not at
// all, and where two write one vertex the value of one of them stays; which one is not promised.
// Where that matters, await the first before the second.
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

/// What one transfer did. Wall-clock seconds are measured on the PE that runs it.
struct TransferSummary {
  double broad = 0;   ///< seconds: boxes to voxels, candidates to the target's Workers
  double narrow = 0;  ///< seconds: questions and answers
  double report = 0;  ///< seconds: vertices outside, new values to all parts that hold them
  Tally tally;        ///< of the target's vertices
};

/// Moves all fields of `source` to `target`; awaited, it is done when every target vertex has its
/// value. `summary` may be null. Both have equally many components.
Task transfer(DistributedMesh source, DistributedMesh target, TransferOptions options,
              TransferSummary* summary);

/// A voxel size for a transfer between these meshes: about 100 source tetrahedra a voxel (measured:
/// 30 costs a third more, 200 no less), and not more than the bound on the number of voxels that a
/// coordinate can name. Depends on the meshes alone.
[[nodiscard]] Point suggest_voxel_size(const TetMesh& source, const TetMesh& target);

}  // namespace tess::m2m
