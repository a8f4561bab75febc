// Measurement-based load balancing of an array:
//
//     tess::start_balancing(blocks, {.strategy = "greedy"});
//
// From then on the runtime measures what elements compute and send. In a balance round a strategy
// sees the measured loads, and elements migrate.
//
//     at_sync     each element calls at_sync() once per phase; when all have called it, a round
//                 runs, and then every element's resume_from_sync() is called
//     automatic   the same barrier, but a round runs only if it pays off
//     periodic    no barrier: a round runs whenever `period` has passed, beside the elements' work;
//                 at_sync() continues immediately
//
// The barrier waits for all elements of the array. One that is created later joins the round that
// is open then. Between two phases that is the round of the next one, if its insertion was awaited
// (co_await epoch(...)); within a phase that of its creator, if the creator awaits it before its
// own at_sync(). An element that is not awaited may come to exist after the end of that round, and
// is in the next one. A new element calls at_sync() in the phase that it was created in, too, but
// not in its constructor if its insertion is awaited: the epoch would wait with it. The barrier
// does not wait for destroyed elements. The balancer ends with its array.
//
// A load is known once a whole phase of the element has been measured. This holds from the first
// round on for an array that is called after an awaited epoch in which it was created and balancing
// started, or after an awaited balancer.begin_phase(). An element that ran before it was measured
// (a call may overtake the start of balancing on its way to another PE) has an unknown load until
// the next phase: it counts as the mean of the others and is not moved. A round without known loads
// moves nothing.
//
// A program whose phases are epochs has a barrier already: between two of them it awaits
// balancer.round(), and no element calls at_sync(). This is the simplest way for arrays whose
// elements come and go.
#pragma once

#include "runtime/array.hpp"
#include "runtime/balance/rounds/balancer.hpp"
#include "runtime/balance_options.hpp"
#include "runtime/core/error.hpp"

namespace tess {

/// The balancer of an array, as a value that can be copied. history() and round() may be called
/// only on the PE that called start_balancing(), and not after the end of the array.
class BalancerProxy {
 public:
  /// It refers to no array, for programs that balance on demand: its rounds return at once and move
  /// nothing, and its history is empty.
  BalancerProxy() = default;
  explicit BalancerProxy(GroupProxy<balance::Balancer> group) : group_(group) {}

  /// The rounds so far, in order. May be called only on the PE that called start_balancing().
  [[nodiscard]] const std::vector<balance::Round>& history() const {
    static const std::vector<balance::Round> none;
    return exists() ? group_.local().history() : none;
  }

  /// Begins the first phase; it is awaited while no element of the array has work. Arrays that ran
  /// before balancing started need it, since their loads would be unknown in the first round. May
  /// be called only on the PE that called start_balancing().
  [[nodiscard]] Task begin_phase() const {
    return exists() ? group_.local().begin_phase() : nothing();
  }

  /// Runs a round after a restart by the loads that the checkpoint has of the elements, so that the
  /// first phase is balanced as those before the checkpoint were. It is awaited after
  /// start_balancing(), while no element of the array has work, in place of begin_phase(). Nothing
  /// moves if the checkpoint has no loads.
  [[nodiscard]] Task place_again() const {
    return exists() ? group_.local().place_again() : nothing();
  }

  /// Runs a round (with `automatic` only if it pays off); it is awaited between two phases, while
  /// no element of the array has work. All moved elements have arrived when it returns. Only
  /// the PE that called start_balancing() may call it, and not with at_sync() or periodic rounds.
  [[nodiscard]] Task round() const { return exists() ? group_.local().phase_ends() : nothing(); }

 private:
  [[nodiscard]] bool exists() const { return group_.id() != CollectionId{}; }
  [[nodiscard]] static Task nothing() { co_return; }

  GroupProxy<balance::Balancer> group_;
};

namespace balance {
/// Elements of this chare have a position, for strategies that cut space.
template <class C>
concept HasPosition = requires(const C& chare) { chare.balance_position(); };
}  // namespace balance

/// Starts balancing an array; may be called once per array. The calling PE coordinates the rounds.
/// Throws Error, before anything is sent, for options with an unknown strategy or prediction, for
/// options that do not match the PEs of the run, and for a strategy that needs positions if the
/// chare has no balance_position().
template <class C>
BalancerProxy start_balancing(ArrayProxy<C> array, const BalanceOptions& options = {}) {
  static_assert(
      requires { sizeof(C); },
      "start_balancing needs the definition of the chare: include its header");
  if constexpr (!balance::HasPosition<C>)
    balance::require_no_positions(options, plain_name(name_of_type<C>));
  return BalancerProxy(balance::start(array.id(), options, {}));
}

/// Starts balancing with the user's own strategy: Assignment(const Snapshot&). Elements that may
/// not move stay, whatever it returns. It must ask each load for its seconds, because some may be
/// unknown (balance/load.hpp). Throws Error also for an empty function.
template <class C>
BalancerProxy start_balancing(ArrayProxy<C> array, const BalanceOptions& options,
                              balance::Strategy strategy) {
  if (!strategy)
    fail(ErrorCode::bad_argument,
         "start_balancing: the strategy is an empty function; give one, or leave it out to use "
         "options.strategy");
  return BalancerProxy(balance::start(array.id(), options, std::move(strategy)));
}

}  // namespace tess
