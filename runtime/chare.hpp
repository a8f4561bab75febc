// The base class of an array's elements:
//
//     class Block : public tess::Chare<Block, tess::Index2> { … };
//
// Any member function that returns void or tess::Task is an entry method. A chare that migrates or
// is created on demand needs a default constructor; a chare that migrates also needs `template
// <class Ar> void serialize(Ar& ar)`.
//
// The default constructor runs again wherever an element is rebuilt from its bytes: after a
// migration to another process, and in a restart. What it contributes, at_sync(), migrate_to() and
// destroy() have no effect then. But messages that it sends, timers that it sets, what it creates
// and coroutines that it starts come again.
#pragma once

#include "runtime/arrays/typed/array_of.hpp"
#include "runtime/arrays/typed/contribution.hpp"
#include "runtime/task.hpp"

namespace tess {

template <class C>
class ArrayProxy;
template <class C, class IndexType>
class ElementProxy;

/// A chare that can wait for its balancer.
template <class C>
concept ResumesFromSync = requires(C& chare) { chare.resume_from_sync(); };

template <class Derived, class IndexType = Index1>
class Chare : public detail::TessContributor<IndexType> {
 public:
  using Index = IndexType;

  /// The index of this element.
  [[nodiscard]] const Index& index() const { return this->index_; }

  /// The array of this element.
  [[nodiscard]] ArrayProxy<Derived> array() const {
    return ArrayProxy<Derived>(this->collection_id());
  }

  /// The proxy of this element.
  [[nodiscard]] ElementProxy<Derived, Index> self() const {
    return {this->collection_id(), this->index_};
  }

  /// Moves this element to a PE once none of its code runs or waits. The current epoch waits for
  /// the move, unless a waiting coroutine delays it (that coroutine may await the epoch).
  void migrate_to(PeId pe) {
    detail::check_exists(current_pe(), pe);
    if (this->is_called_directly()) {
      self().migrate_to(pe);
    } else {
      this->migrate_to_ = pe;
    }
  }

  /// Destroys this element once none of its code runs or waits.
  void destroy() {
    if (this->is_called_directly()) {
      self().destroy();
    } else {
      this->destroy_requested_ = true;
    }
  }

  /// Marks the end of this element's part of the phase, at the balancer's barrier
  /// (start_balancing). Once all elements have called it and the round is over, resume_from_sync()
  /// is called on the PE where the element then is. Other messages may run meanwhile; calling
  /// at_sync() again before resume_from_sync() is an error.
  void at_sync() {
    static_assert(ResumesFromSync<Derived>,
                  "a chare that calls at_sync() needs a member function resume_from_sync()");
    if (this->collection_ == nullptr) [[unlikely]] {
      detail::Element::after_construction("at_sync()", [this] { at_sync(); });
    } else {
      this->collection_->at_sync(*this);
    }
  }

  /// The number of the reduction that this element's next contribution belongs to. After this call
  /// a new element keeps this number. A constructor must not call it.
  [[nodiscard]] std::uint32_t next_reduction() {
    this->collection_->settle_join(*this);
    return this->state_.next_reduction;
  }

  /// Contributes this element's value to the next reduction of the array; every element contributes
  /// one value. The result goes to `target`. in_order(op) combines the values in the order of
  /// indices. A constructor's contribution is to the first reduction of the element; an element
  /// that is rebuilt after a migration does not repeat it.
  ///
  /// A new element receives the broadcasts that reach its PE after its construction. It joins at
  /// the first reduction that its PE has not reported and that no earlier broadcast led to. So an
  /// element that is created after a result was awaited takes part only in later rounds, and an
  /// element that is created in the middle of a round takes part in the round if it receives its
  /// broadcast. A broadcast leads to the contributions of its entry method, and of the coroutines,
  /// timers and messages between elements of the array that follow from it.
  ///
  /// If rounds overlap (one is started before the result of the last one is known) while elements
  /// are inserted, name them: contribute(RoundId{k}, …) gives a value of round k, and
  /// insert(RoundId{k}, …) an element that is in round k and later ones. Calls may overtake each
  /// other then. Otherwise insert elements while no round is under way, and await an epoch around
  /// it, in two cases. If rounds overlap: a new element that contributes to a round before its
  /// first is refused by name. And if elements contribute in an entry method that another array or
  /// group calls, or the main program: an element whose insertion was not awaited is refused by
  /// name (a coroutine of a broadcast that awaits such a message is no such case).
  using detail::TessContributor<IndexType>::contribute;
};

}  // namespace tess
