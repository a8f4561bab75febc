// Parallel collision detection with voxels. Clients submit boxes on their PEs; a collision finds
// all pairs of boxes that overlap, each once, and sends them to the owners of the boxes.
//
// Sample: tests/samples/collider.cpp
//
//     void submit(const tess::collide::Collider& collider) { collider.submit(boxes()); }
//     void receive(const tess::collide::Hits& hits) { n_pairs_ += hits.pairs.size(); }
//
// The main coroutine:
//
// Sample: tests/samples/collider.cpp
//
//     const auto collider = tess::collide::make_collider({.size = {1, 1, 1}});
//     const auto clients = tess::create<Client>(tess::range(8));
//     co_await tess::epoch([&] { clients.broadcast<&Client::submit>(collider); });
//     const tess::collide::Report report{tess::collide::report_to<&Client::receive>(clients), {}};
//     co_await tess::collide::run_collision(collider, report);
//
// submit() is a call to the local Manager. Before a collision, the main coroutine awaits an epoch
// in which the clients submit. run_collision() awaits two epochs: the delivery of the boxes to the
// voxels, then the search in the voxels together with the handling of the hits by the owners. The
// voxels remain for the next collision; a voxel that has no boxes then is destroyed.
//
// The voxels can be balanced: call tess::start_balancing(collider.voxels, options) before the first
// collision, and co_await balancer.round() between two collisions. Measured loads are stored by the
// index of the voxel.
#pragma once

#include "collide/parallel/manager.hpp"
#include "collide/parallel/report.hpp"
#include "collide/parallel/voxel.hpp"
#include "runtime/runtime.hpp"

#include <utility>
#include <vector>

namespace tess::collide {

/// The grid, and the pairs that are hits.
struct ColliderOptions {
  Point origin{0, 0, 0};
  Point size{1, 1, 1};
  PairRules rules{};
};

/// A handle to the voxels and Managers of a collider. It can be copied and sent.
struct Collider {
  ArrayProxy<Voxel> voxels;
  GroupProxy<Manager> managers;
  ColliderOptions options;

  /// Passes objects of a client on this PE to the local Manager. Throws Error as it does.
  void submit(std::vector<Item> items) const { managers.local().submit(std::move(items)); }

  /// Frees the voxels, their balancer and the Managers on all PEs. No collision may be running. The
  /// enclosing epoch includes this.
  void destroy() const {
    voxels.destroy();
    managers.destroy();
  }
};

/// Creates the Managers and an empty array of voxels. Throws Error for a voxel size that is not
/// positive.
[[nodiscard]] Collider make_collider(const ColliderOptions& options);

/// Collides all objects that were submitted. When the task is done, the owners have handled all
/// hits.
Task run_collision(Collider collider, Report report);

/// The two halves of run_collision(), for callers that time them. Await an epoch around each.
void start_delivery(const Collider& collider);
void start_collision(const Collider& collider, const Report& report);

}  // namespace tess::collide
