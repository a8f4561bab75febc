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
//     tess::collide::Collider collider;
//     co_await tess::epoch([&] { collider = tess::collide::make_collider({}); });
//     const auto clients = tess::create<Client>(tess::range(8));
//     co_await tess::epoch([&] { clients.broadcast<&Client::submit>(collider); });
//     co_await collider.run(tess::collide::report_to<&Client::receive>(clients));
//
// submit() is a call to the local Manager, so the epoch that makes the collider is awaited first
// (submit_early() does without). Before a collision, the main coroutine awaits an epoch
// in which the clients submit. run() collides what was submitted: it chooses the voxels from all
// objects, and is done when the owners have handled all hits. A voxel starts as soon as its objects
// are there. Collisions of several colliders may overlap. Those of one may, too, if its
// clients submit for the next one only when the objects of the one before are taken on all PEs,
// which it reports: a collision takes what it finds on each PE.
//
// Long thin objects may be submitted with capsules (capsule.hpp). If that pays, they are searched
// in pieces, and pairs whose capsules are certainly apart are not reported: the receiver tests
// fewer.
//
// Objects that move little from a collision to the next: give ColliderOptions::slack. Then most
// collisions only test pairs that were near before.
//
// The voxels remain for the next collision; retire() ends those that are idle. They can be
// balanced: call tess::start_balancing(collider.voxels, options) before the first collision, and
// co_await balancer.round() between two collisions. Measured loads are stored by the index of the
// voxel.
#pragma once

#include "collide/collider_options.hpp"
#include "collide/hit_receivers.hpp"
#include "collide/objects.hpp"
#include "collide/parallel/voxel.hpp"
#include "runtime/runtime.hpp"

#include <span>
#include <vector>

namespace tess::collide {

class Manager;
class Neighbours;

/// A handle to the voxels and Managers of a collider. It can be copied and sent.
struct Collider {
  ArrayProxy<Voxel> voxels;
  GroupProxy<Manager> managers;
  ColliderOptions options;
  GroupProxy<Neighbours> neighbours{};  ///< if there is a slack

  /// Pass objects of a client on this PE to the local Manager, or Neighbours, which copies them.
  /// They throw Error as it does. Return the number of objects that ColliderOptions::invalid_boxes
  /// leaves out.
  std::size_t submit(const Objects& objects) const;
  std::size_t submit(const std::vector<Item>& items, std::span<const Capsule> capsules = {}) const;
  /// Submits within the epoch that creates the collider. If it is not known on this PE yet, the
  /// objects are a message that waits for it; then a box that is not valid ends the job.
  void submit_early(Submission objects) const;

  /// Collides all objects that were submitted. When the task is done, the owners have handled all
  /// hits. Calls `taken`, unless it is empty, when clients may submit for the next collision.
  /// Throws Error: bad_argument if `to` has no call; out_of_range if a coordinate exceeds the range
  /// of cells, and then the objects are dropped.
  Task run(HitReceivers to, Callback<void> taken = {}) const;
  /// What the last collision did, on all PEs. No collision may be running.
  [[nodiscard]] Future<CollisionStatistics> statistics() const;
  /// Ends the voxels that had no objects since the last call, and frees the memory that Managers
  /// keep for the next collision. The enclosing epoch includes this. No collision may be running.
  void retire() const;
  /// Frees the voxels, their balancer and the Managers on all PEs. The enclosing epoch includes
  /// this. It is an error while a collision runs, whose hits would be lost: it ends the job with a
  /// message, at once if this PE started the collision or has not sent its objects yet.
  void destroy() const;
};

/// Creates the Managers and an empty array of voxels. Throws Error for a voxel size that is not
/// positive, or zero on some axes only, for a length of pieces that is negative or NaN, and for a
/// slack that is negative or not finite.
[[nodiscard]] Collider make_collider(const ColliderOptions& options);

}  // namespace tess::collide
