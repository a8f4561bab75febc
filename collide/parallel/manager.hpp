// A group with one member per PE (Lawlor and Kalé 2002, section 3.3). Clients on the PE pass their
// objects to it. In a collision the Managers
//
//     prepare    say what they have; one PE makes the plan
//     begin      sort their objects into voxels, and report their number to the home of each voxel
//     answer     as homes, leave out voxels that can have no pair, and say how many PEs send to a
//                voxel, and which of them makes it
//     deliver    send one message per voxel, which starts at once when it has heard from all; to the
//                Managers of other processes one message for several voxels
//
// There is no barrier: a voxel does not wait for other voxels, and several collisions may overlap.
// The reports of Managers to homes, and the answers, are exchanged in a few messages
// (exchange.hpp).
#pragma once

#include "collide/collider_options.hpp"
#include "collide/hit.hpp"
#include "collide/objects.hpp"
#include "collide/parallel/delivery_pool.hpp"
#include "collide/parallel/exchange.hpp"
#include "collide/parallel/part.hpp"
#include "collide/parallel/plan.hpp"
#include "collide/parallel/shipment.hpp"
#include "collide/parallel/voxel.hpp"
#include "collide/parallel/voxel_sort.hpp"
#include "runtime/core/algorithm.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace tess::collide {

/// Throws Error unless n is 0: a checkpoint saves no objects that wait for the next collision.
void refuse_submitted(std::size_t n);

class Manager : public Group<Manager> {
 public:
  Manager() = default;  ///< for restarts
  explicit Manager(ArrayProxy<Voxel> voxels) : voxels_(voxels) {}

  /// Accept objects of a client on this PE. They throw Error with the object if a box is not valid,
  /// or if numbers do not fit into 32 bits; then no object of the list is accepted.
  void submit(const Objects& objects) { pending().append(objects, pe()); }
  void submit(const std::vector<Item>& items, std::span<const Capsule> capsules) {
    pending().append(items, capsules, pe());
  }
  /// Entry method: the same for objects that were submitted before the Manager was known.
  void receive(const Submission& late) { submit(Objects{late.owner, late.model, late.boxes}); }

  /// A number for a collision that starts on this PE, and calls end_step() at its end.
  [[nodiscard]] std::uint64_t new_step() {
    ++n_running_;
    return static_cast<std::uint64_t>(pe().value) << 40 | ++n_steps_;
  }
  void end_step() { --n_running_; }
  /// True while a collision runs that started on this PE, or has objects on it to send.
  [[nodiscard]] bool is_colliding() const { return n_running_ != 0 || !rounds_.empty(); }

  /// The summary has so many boxes of this PE.
  void prepare(std::uint64_t step, std::size_t n_sampled, const ArrayProxy<Voxel>& voxels,
               const Callback<Summary>& target);
  /// The same for objects that come from another place than submit().
  [[nodiscard]] Summary take(std::uint64_t step, ObjectList objects, std::size_t n_sampled);
  /// Without a plan: the objects are dropped.
  void begin(std::uint64_t step, const Plan& plan, const HitReceivers& receivers);
  void receive_records(std::uint64_t step, const Bundle<VoxelRecord>& bundle);
  void receive_answers(std::uint64_t step, const Bundle<VoxelAnswer>& bundle);
  /// Sends some voxels' parts; then the next ones, when other messages had their turn.
  void deliver(std::uint64_t step);
  /// The parts for voxels that this PE makes.
  void receive_shipment(const Shipment& shipment);
  /// Sends the pairs of a voxel on this PE that has too many for one message. The next portion is
  /// searched when the owners have handled the last one; one voxel of a PE after another.
  Task search_in_portions(std::vector<Part> parts);

  /// Frees the memory that is kept for the next collision.
  void shrink() { pool_.shrink(); }

  /// Pairs of larger boxes that this PE tested, after a search for them or alone.
  void note_kept(std::uint64_t n, bool after_search) {
    if (!after_search) last_ = {};
    last_.n_kept = n;
    last_.searched = after_search;
  }
  /// What this PE did in the last collision.
  [[nodiscard]] const CollisionStatistics& last() const { return last_; }
  void report_last(const Callback<CollisionStatistics>& target) { contribute(sum, last_, target); }

  /// For checkpoints. Throws Error (bad_value) if objects were submitted for
  /// the next one.
  template <class Ar>
  void serialize(Ar& ar) {
    refuse_submitted(pending_ == nullptr ? 0 : pending_->objects.size());
    ar(last_);  // prepare() sets the voxels, also on a PE that the run before had not
  }
  void absorb(Manager&& other) { last_ = last_ + other.last_; }

 private:
  /// A collision, as its sender and as the home of voxels.
  struct Round {
    Round(std::int32_t me, std::int32_t n_pes) : records(me, n_pes), answers(me, n_pes) {}

    std::shared_ptr<Delivery> delivery;
    CollisionStatistics statistics;
    std::vector<std::uint32_t> by_home;  // positions in the sort's records, home after home
    std::vector<std::uint32_t> ends;     // by home, in by_home
    Exchange<VoxelRecord> records;
    Exchange<VoxelAnswer> answers;

    std::vector<VoxelAnswer> answer_of;  // per record
    std::size_t n_delivered = 0;         // records
    std::uint32_t begin = 0;             // of the next one's entries
  };
  ObjectList& pending();
  Round& round(std::uint64_t step);
  /// Sends bundles of an exchange to the entry method F.
  template <auto F>
  auto sender(std::uint64_t step);
  void answer_if_asked(std::uint64_t step, Round& round);
  void deliver_if_answered(std::uint64_t step, Round& round);
  /// Sends the parts of this process, of the records from `first` to r.n_delivered, whose entries
  /// begin at `begin`.
  void deliver_here(const Round& r, std::size_t first, std::uint32_t begin);

  ArrayProxy<Voxel> voxels_;
  DeliveryPool pool_;
  std::shared_ptr<Delivery> pending_;      // what is submitted for the next collision
  std::map<std::uint64_t, Round> rounds_;  // by step
  bool is_searching_ = false;              // in portions
  std::deque<Callback<void>> turns_;       // of the voxels that wait for it
  std::uint64_t n_steps_ = 0;
  std::uint64_t n_running_ = 0;  // of them
  CollisionStatistics last_;
};

}  // namespace tess::collide
