// Moves fields from one mesh to another that overlaps it (the five steps of the ExaM2M slides); the
// library holds both meshes. Applications with meshes of their own use coupling.hpp. Call these
// functions in a coroutine, on one PE:
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
//     const TransferSummary summary = co_await transfer(source, target, {.policy = Nearest{}});
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
//     auto first = transfer(a, b, {});
//     auto second = transfer(a, c, {});
//     co_await first;
//     co_await second;
//
// To move fields several times, keep the donors:
//
// Sample: tests/samples/transfer.cpp
//
//     Transfer repeated(source, target, {.policy = Nearest{}});
//     co_await repeated.search();
//     for (int step = 0; step < 10; ++step) co_await repeated.apply();
//     co_await epoch([&] { repeated.destroy(); });
//
// If one of two concurrent transfers reads the mesh that the other writes, it sees the result of
// the other completely or not at all. If both write to the same vertex, one of the two values
// remains, and it is not defined which. Await the first transfer before the second if that matters.
#pragma once

#include "m2m/coupling.hpp"
#include "m2m/mesh/workers/scatter.hpp"
#include "m2m/mesh/workers/worker.hpp"

namespace tess::m2m {

using TransferOptions = CouplingOptions;

/// A handle to the donors of the vertices of one mesh in another.
class Transfer {
 public:
  /// Both meshes have equally many components.
  Transfer(const DistributedMesh& source, const DistributedMesh& target,
           const TransferOptions& options);

  /// Finds the donors.
  TaskOf<SearchSummary> search() { return coupling_.search(); }
  /// Moves all fields. When the task is done, every target vertex has its value. Applications of
  /// one Transfer run one after the other, in the order of the calls.
  Task apply();
  /// Frees what the Workers hold of it. The enclosing epoch includes this.
  void destroy() { coupling_.destroy(); }
  [[nodiscard]] const Coupling<Worker, Worker>& coupling() const { return coupling_; }

 private:
  Coupling<Worker, Worker> coupling_;
  ArrayProxy<Worker> target_;
};

/// Times and counts of one transfer. Times are wall-clock seconds on the calling PE.
struct TransferSummary {
  SearchSummary search;
  double apply = 0;  ///< interpolation, values, ghosts
};

/// A search and one application.
TaskOf<TransferSummary> transfer(DistributedMesh source, DistributedMesh target,
                                 TransferOptions options);

}  // namespace tess::m2m
