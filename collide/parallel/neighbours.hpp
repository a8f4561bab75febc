// A group with one member per PE for colliders with a slack: it keeps pairs (kept_pairs.hpp) from
// one collision for those after it. Clients pass their objects to it. In a collision the members
//
//     prepare    say whether their kept pairs hold for what was submitted
//     enlarge    if one does not: pass larger boxes to the Managers, which find their pairs as those of
//                any client; the pairs come back here (keep)
//     match      exchange the boxes of objects that are in pairs with those of another PE, test the
//                pairs, and send hits to the owners. After a search they ask for these objects before
//
// There is no state in voxels, so they may be moved or retired.
#pragma once

#include "collide/parallel/exchange.hpp"
#include "collide/parallel/kept_pairs.hpp"
#include "collide/parallel/manager.hpp"
#include "collide/parallel/plan.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace tess::collide {

/// Objects of a PE, for another one.
struct Copies {
  ObjectList objects;
  template <class Ar>
  void serialize(Ar& ar) {
    objects.serialize(ar, nullptr);
  }
};

class Neighbours : public Group<Neighbours> {
 public:
  Neighbours(GroupProxy<Manager> managers, PairRules rules, double slack)
      : managers_(managers), rules_(rules), slack_(slack) {}

  /// As Manager::submit(). Throws Error (bad_argument) for capsules: an object may turn within its
  /// box.
  void submit(const Objects& objects);
  void submit(const std::vector<Item>& items, std::span<const Capsule> capsules);
  void receive(const Submission& late) { submit(Objects{late.owner, late.model, late.boxes}); }

  /// Takes what was submitted. The result is the collision whose pairs hold on all PEs, or 0.
  void prepare(std::uint64_t step, const Callback<std::uint64_t>& target);
  /// Passes the objects to the Managers for their collision `search`, with larger boxes or, for the
  /// last time, with their own. The result is for make_plan().
  void enlarge(std::uint64_t step, std::uint64_t search, bool larger, std::size_t n_sampled,
               const Callback<Summary>& target);
  void keep(std::uint64_t step, Hits found);
  /// The result: true if a PE was given too many pairs to keep.
  void count(std::uint64_t step, const Callback<bool>& target);
  void match(std::uint64_t step, const HitReceivers& to);
  void receive_requests(std::uint64_t step, const Bundle<std::uint32_t>& bundle);
  void receive_copies(std::uint64_t step, std::int32_t from, Copies copies);
  /// Tests some of the pairs; then the next ones, when other messages had their turn.
  void test(std::uint64_t step);
  void receive_boxes(std::uint64_t step, std::int32_t from, std::vector<Aabb> boxes);
  /// The collision was refused; the next one may keep pairs again.
  void drop(std::uint64_t step) {
    rounds_.erase(step);
    keeps_none_ = false;
  }
  /// Frees what is kept. The next collision searches.
  void forget();

  [[nodiscard]] bool is_colliding() const { return !rounds_.empty(); }
  /// Pairs were too many once, or a larger box had no cell: collisions are those of the Managers,
  /// until forget().
  [[nodiscard]] bool keeps_none() const { return keeps_none_; }

 private:
  struct Round {
    Round(std::int32_t me, std::int32_t n_pes) : requests(me, n_pes) {}

    ObjectList now;
    std::shared_ptr<KeptPairs> pairs;  // kept, or found in this collision
    bool is_search = false;
    bool may_test = false;  // match() has come
    HitReceivers receivers;
    Exchange<std::uint32_t> requests;  // after a search
    KeptPairs::Boxes boxes;            // of other PEs' objects
    KeptPairs::Progress progress;
  };
  Round& round(std::uint64_t step) {
    return rounds_.try_emplace(step, pe().value, n_pes()).first->second;
  }
  auto request_sender(std::uint64_t step);
  void answer_if_asked(std::uint64_t step, Round& r);
  void test_if_complete(std::uint64_t step, Round& r);

  const GroupProxy<Manager> managers_;
  const PairRules rules_;
  const double slack_;
  ObjectList pending_;  // what is submitted for the next collision
  ObjectList spare_;    // its memory
  std::map<std::uint64_t, Round> rounds_;
  std::shared_ptr<KeptPairs> kept_;
  bool keeps_none_ = false;
};

/// Calls Neighbours::keep() of the PE that owns the objects of larger_objects().
[[nodiscard]] Callback<Hits> report_to_neighbours(const GroupProxy<Neighbours>& neighbours,
                                                  std::uint64_t step);

}  // namespace tess::collide
