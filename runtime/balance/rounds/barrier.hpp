// The at_sync() barrier of an array on one PE. It counts as a reduction does (see ReductionTree):
// members contribute to round r on any PE, creation and destruction change the membership, and the
// coordinator is notified once all have contributed.
//
// Elements that exist on a PE when balancing starts there are members from round 0 on. The barrier
// does not wait for a later element until it calls at_sync() for the first time, which it may never
// do. If the element's PE has not reported the open round by then, the element joins that round;
// otherwise it waits beside the barrier, is resumed with the others, and joins the next round.
//
// Until begin(), an artificial member of round 0 keeps this PE from reporting: the array may not be
// known here yet, and an element that left its PE before balancing started there may be under way
// to this PE. The coordinator adds up the number of such elements (Collection::n_away at attach);
// each reports when it arrives.
#pragma once

#include "runtime/balance/rounds/internals.hpp"
#include "runtime/callback.hpp"

namespace tess::balance {

class Barrier {
 public:
  /// `group` is the balancer's collection, to which the messages of the barrier's tree are sent.
  Barrier(Pe& pe, Collection& group, PeId coordinator, Callback<std::uint64_t> reached);

  /// Starts balancing here: all present elements are members from round 0 on.
  void attach(Collection& array);
  /// Detaches from the array: no element is waited for or resumed any more.
  void detach() { array_ = nullptr; }
  /// All members of round 0 are known, on all PEs.
  void begin();

  // Events of the array's elements.

  /// Returns true if the element is a member of round 0 that was under way when balancing started.
  bool entered(Element& element);
  void left(Element& element);
  void destroyed(Element& element);
  void at_sync(Element& element);

  /// Ends a round: all elements that wait for it continue.
  void resume(std::uint32_t round);

 private:
  void join_first(SyncState& sync);
  void contribute(SyncState& sync);
  void wake(Element& element);
  [[nodiscard]] std::string missing_before(std::uint32_t round) const;

  const Callback<std::uint64_t> reached_;
  ReductionHostOfCollection host_;
  ReductionTree tree_;
  Collection* array_ = nullptr;
  std::uint32_t n_resumed_ = 0;  // rounds 0 … n_resumed_ − 1 are over
};

}  // namespace tess::balance
