// The at_sync() barrier of an array on one PE. It counts as a reduction does (see ReductionTree):
// members contribute to round r on any PE, creation and destruction change the membership, and the
// coordinator is notified once all have contributed.
//
// Elements that exist on a PE when balancing starts there are members from round 0 on. A later
// element joins the round that is open when it is created, and the barrier waits for it. If its PE
// has reported no round but those that it knows to be over, the open round is the next one here.
// Otherwise the element is held here until the coordinator has counted it and answered, in the
// epoch of its creation. So elements that are created in an awaited epoch between two phases join
// the round after it; and those whose creator awaits them before its own at_sync(), the creator's.
//
// Until begin(), an artificial member of round 0 keeps this PE from reporting: the array may not be
// known here yet, and an element that left its PE before balancing started there may be under way
// to this PE. The coordinator adds up the number of such elements (Collection::n_away at attach);
// each reports when it arrives.
#pragma once

#include "runtime/balance/rounds/internals.hpp"
#include "runtime/callback.hpp"

#include <cstdint>
#include <map>

namespace tess::balance {

class Barrier {
 public:
  /// `group` is the balancer's collection, to which the messages of the barrier's tree are sent.
  Barrier(Pe& pe, Collection& group, PeId coordinator, Callback<std::uint64_t> reached);

  /// Starts balancing here: all present elements are members from round 0 on.
  void attach(Collection& array);
  /// Detaches from the array: no element is waited for, resumed or held any more.
  void detach();
  /// All members of round 0 are known, on all PEs.
  void begin();

  // Events of the array's elements.

  enum class Entrant : std::uint8_t {
    usual,
    late,      ///< a member of round 0 that was under way when balancing started
    newcomer,  ///< it was created here, and the coordinator knows which round it joins: hold()
  };
  [[nodiscard]] Entrant entered(Element& element);
  /// Holds a newcomer until joins() is called with the ticket that is returned.
  [[nodiscard]] std::uint32_t hold(Element& element);
  /// On the coordinator: counts a newcomer of some PE as a member from the open round on, which is
  /// returned.
  [[nodiscard]] std::uint32_t admit() { return tree_.admit(); }
  void joins(std::uint32_t ticket, std::uint32_t round);
  void left(Element& element);
  void destroyed(Element& element);
  void at_sync(Element& element);

  /// Ends a round: all elements that wait for it continue.
  void resume(std::uint32_t round);

 private:
  void join(SyncState& sync, std::uint32_t round);
  void contribute(SyncState& sync);
  [[nodiscard]] std::string missing_before(std::uint32_t round) const;

  const Callback<std::uint64_t> reached_;
  ReductionHostOfCollection host_;
  ReductionTree tree_;
  Collection* array_ = nullptr;
  std::uint32_t n_resumed_ = 0;                  // rounds 0 … n_resumed_ − 1 are over
  std::map<std::uint32_t, Element*> newcomers_;  // those held, by ticket
  std::uint32_t n_tickets_ = 0;
};

}  // namespace tess::balance
