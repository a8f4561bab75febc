// Measurement-based load balancing of an array: tess::start_balancing(blocks, {.strategy =
// "greedy"}). What elements cost and send is measured from then on; at a round a strategy sees the
// measured loads, and elements migrate.
//
//     at_sync     each element calls at_sync() once a phase; when all have, a round runs, and then
//                 every element's resume_from_sync() is called
//     automatic   the same barrier, but a round runs only when it is worth its cost
//     periodic    no barrier: a round whenever `period` has passed, beside the elements' work
//
// Elements that exist where balancing starts are waited for from the first round on; later ones
// from their first at_sync() on. An element that ends is no longer waited for. The balancer ends
// with its array.
//
// A load is known once a whole phase of the element was measured. That is so from the first round
// on for arrays that are created, balanced and only then called. An element that ran before it was
// measured has an unknown load until the next phase: it counts as the mean of the others and is not
// moved; a round without known loads moves nothing. A program that starts balancing later awaits
// balancer.begin_phase() before it goes on.
//
// A program whose phases are epochs has a barrier already: between two of them it awaits
// balancer.round(), and no element calls at_sync(). That is the way for arrays whose elements come
// and go: at a barrier of theirs an element may be too new for the phase that ends, and would wait
// for the next.
#pragma once

#include "runtime/array.hpp"
#include "runtime/balance/rounds/balancer.hpp"
#include "runtime/balance/rounds/options.hpp"

namespace tess {

/// The balancer of an array. A value that can be copied; history() on the PE that started it. After
/// the end of the array neither history() nor round() may be called.
class BalancerProxy {
 public:
  BalancerProxy() = default;
  explicit BalancerProxy(GroupProxy<balance::Balancer> group) : group_(group) {}

  /// The rounds so far, in order. On the PE that called start_balancing() alone.
  [[nodiscard]] const std::vector<balance::Round>& history() const {
    return group_.local().history();
  }

  /// Awaited while no element of the array has work: its first phase begins here. For arrays that
  /// have run before balancing starts, whose loads would not be known in the first round. On the PE
  /// that called start_balancing() only.
  [[nodiscard]] Task begin_phase() const { return group_.local().begin_phase(); }

  /// Awaited between two phases, while no element of the array has work: a round (automatic: where
  /// it is worth it); all that it moves has arrived. On the PE that called start_balancing() alone.
  /// Not beside at_sync(), nor periodic rounds.
  [[nodiscard]] Task round() const { return group_.local().phase_ends(); }

 private:
  GroupProxy<balance::Balancer> group_;
};

/// Balances an array from now on; once an array. The PE that calls it coordinates the rounds.
/// Throws Error for options that name no strategy or prediction, or that fit not the PEs of the
/// run.
template <class C>
BalancerProxy start_balancing(ArrayProxy<C> array, const BalanceOptions& options = {}) {
  return BalancerProxy(balance::start(array.id(), options, {}));
}

/// The same by the user's own strategy: Assignment(const Snapshot&), of which what may not be moved
/// is left where it is.
template <class C>
BalancerProxy start_balancing(ArrayProxy<C> array, const BalanceOptions& options,
                              balance::Strategy strategy) {
  return BalancerProxy(balance::start(array.id(), options, std::move(strategy)));
}

}  // namespace tess
