// The voxel collision library, as clients see it:
//
//     auto collider = tess::make_collider({.size = {s, s, s}});          once, anywhere
//     collider.submit(items);                                            each client, on its PE
//     co_await tess::collide(collider, {tess::report_to<&Client::hits>(clients), {}});
//
// submit() is a plain call to the local Manager. Whoever runs the collision first awaits an epoch
// in which the clients submit. collide() awaits delivery, then the voxels' work and the owners'
// handling of the hits: each by an epoch, no receipt is counted. The voxels stay for the next
// collision; one that it finds without objects ends.
//
// The voxels can be balanced: tess::start_balancing(collider.voxels, options) before the first
// collision, and co_await balancer.round() between two of them. What is measured and predicted of a
// voxel is remembered by its index.
#pragma once

#include "collide/parallel/manager.hpp"
#include "collide/parallel/report.hpp"
#include "collide/parallel/voxel.hpp"
#include "runtime/runtime.hpp"

#include <utility>
#include <vector>

namespace tess::collide {

/// The grid and which pairs are hits.
struct ColliderOptions {
  Point origin{0, 0, 0};
  Point size{1, 1, 1};
  PairRules rules;
};

/// A value that can be sent: the proxies of the voxels and Managers of one collider.
struct Collider {
  ArrayProxy<Voxel> voxels;
  GroupProxy<Manager> managers;
  ColliderOptions options;

  /// Hands objects of a client on this PE to the local Manager.
  void submit(std::vector<Item> items) const { managers.local().submit(std::move(items)); }

  /// Ends the collider, between two collisions: its voxels (with their balancer) and Managers are
  /// freed on all PEs. The epoch that runs waits for that.
  void destroy() const {
    voxels.destroy();
    managers.destroy();
  }
};

/// Makes the (empty) array of voxels and the Managers. Throws Error for a voxel size that is not
/// positive.
[[nodiscard]] Collider make_collider(const ColliderOptions& options);

/// One collision of all that was submitted; awaited, it is done when the owners have handled all
/// hits.
Task run_collision(Collider collider, Report report);

/// The two halves of collide(), for callers that time them: each inside an epoch of the caller.
void start_delivery(const Collider& collider);
void start_collision(const Collider& collider, const Report& report);

}  // namespace tess::collide
