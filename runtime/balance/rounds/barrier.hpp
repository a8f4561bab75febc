// The at_sync() barrier of an array, on one PE. Its arithmetic is that of a reduction (see
// ReductionTree): members contribute to round r wherever they are, births and deaths change the
// membership, and the coordinator hears once all have contributed.
//
// Who is a member? Elements that are on their PE when balancing starts there, from round 0 on. An
// element that is born later is not waited for until it calls at_sync() for the first time: it may
// never do so. If its PE has not reported the open round by then it joins that round; otherwise it
// waits beside the barrier, is resumed with the others, and joins the next.
//
// Until balancing has started here a phantom member of round 0 keeps this PE from reporting: the
// array may not be known here yet.
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
  [[nodiscard]] bool attached() const { return array_ != nullptr; }

  // What the array's elements do.
  void entered(Element& element);
  void left(Element& element);
  void died(Element& element);
  void at_sync(Element& element);

  /// Round `round` is over: all that wait for it go on.
  void resume(std::uint32_t round);

 private:
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
