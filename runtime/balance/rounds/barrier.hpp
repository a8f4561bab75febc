// The at_sync() barrier of an array, on one PE. Its arithmetic is that of a reduction (see
// ReductionTree): members contribute to round r wherever they are, births and deaths change the
// membership, and the coordinator hears once all have contributed.
//
// Who is a member? Elements that are born before balancing starts on their PE, from round 0 on. An
// element that is born later is not waited for until it calls at_sync() for the first time: it may
// never do so. If its PE has not reported the open round by then it joins that round; otherwise it
// waits beside the barrier, is resumed with the others, and joins the next.
//
// Until begin() a phantom member of round 0 keeps this PE from reporting: the array may not be
// known here yet, and an element that left its PE before balancing started there may be under way
// to this one. How many are, the coordinator adds up (Collection::n_away at attach); each tells of
// itself when it lands.
#pragma once

#include "runtime/callback.hpp"
#include "runtime/collections/collection.hpp"

namespace tess::balance {

class Barrier {
 public:
  /// `group`: the balancer's collection, which the messages of the barrier's tree go to.
  Barrier(Pe& pe, Collection& group, PeId coordinator, Callback<std::uint64_t> reached);

  /// Balancing starts here: all elements present are members from round 0 on.
  void attach(Collection& array);
  /// Lets go of the array: no element is waited for or resumed any more.
  void detach() { array_ = nullptr; }
  /// All members of round 0 have been found, on all PEs.
  void begin();

  // What the array's elements do.

  /// True if it is a member of round 0 that was under way when balancing started.
  bool entered(Element& element);
  void left(Element& element);
  void destroyed(Element& element);
  void at_sync(Element& element);

  /// Round `round` is over: all that wait for it go on.
  void resume(std::uint32_t round);

 private:
  void join_first(SyncState& sync);
  void contribute(SyncState& sync);
  void wake(Element& element);
  [[nodiscard]] std::string missing_before(std::uint32_t round) const;

  Pe& pe_;
  const Callback<std::uint64_t> reached_;
  ReductionTree tree_;
  Collection* array_ = nullptr;
  std::uint32_t n_resumed_ = 0;  // rounds 0 … n_resumed_ − 1 are over
};

}  // namespace tess::balance
