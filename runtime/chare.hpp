// The base of an array's elements: class Block : public tess::Chare<Block, tess::Index2> { … };
// Any member function that returns void or tess::Task is an entry method. A chare that is to
// migrate (or is created on demand) has a default constructor; one that is to migrate also has
// `template <class Ar> void serialize(Ar& ar)`.
#pragma once

#include "runtime/collections/array_of.hpp"
#include "runtime/collections/contribution.hpp"
#include "runtime/task.hpp"

namespace tess {

template <class C>
class ArrayProxy;

/// A chare that can wait for its balancer.
template <class C>
concept ResumesFromSync = requires(C& chare) { chare.resume_from_sync(); };

template <class Derived, class IndexType = Index1>
class Chare : public IndexedElement<IndexType> {
 public:
  using Index = IndexType;

  /// Which element this is.
  [[nodiscard]] const Index& index() const { return this->index_; }

  /// The array it is an element of.
  [[nodiscard]] ArrayProxy<Derived> array() const {
    return ArrayProxy<Derived>(this->collection_id());
  }

  /// Moves this element to a PE once what runs of it, and what waits, is done. The epoch that runs
  /// waits for the move, unless a coroutine puts it off: that may be the one that awaits the epoch.
  void migrate_to(PeId pe) {
    check_exists(current_pe(), pe);
    this->migrate_to_ = pe;
  }

  /// Ends this element once what runs of it, and what waits, is done.
  void destroy() { this->destroy_requested_ = true; }

  /// At the balancer's barrier (start_balancing): this element has done its part of the phase, and
  /// waits. Once all members have said so and the round is over, its resume_from_sync() is called,
  /// on the PE where it then is. Nothing of it but that has to run meanwhile: messages may, but a
  /// second at_sync() before the resume is misuse.
  void at_sync() {
    static_assert(ResumesFromSync<Derived>,
                  "a chare that calls at_sync() has a member function resume_from_sync()");
    if (this->collection_ == nullptr) [[unlikely]] {
      Element::after_construction("at_sync()", [this] { at_sync(); });
    } else {
      this->collection_->at_sync(*this);
    }
  }

  /// The number of the reduction that the next contribution belongs to. A newborn element that has
  /// asked stays with that number; not for use in a constructor.
  [[nodiscard]] std::uint32_t next_reduction() {
    this->collection_->settle_join(*this);
    return this->state_.next_reduction;
  }

  /// Gives this element's value to the next reduction of the array; every element gives one. The
  /// whole goes to `target`. in_order(op) combines in the order of indices. A constructor's
  /// contribution is to the first reduction that the element is in; an element that is made again
  /// where it has migrated does not repeat it.
  ///
  /// An element that is born meets the broadcasts that reach its PE after its birth, and joins at
  /// the first reduction that its PE has not reported and that no broadcast before its birth led
  /// to. So one that is born after a result was awaited takes part in later rounds only; one that
  /// is born in the middle of a round takes part in it if it meets its broadcast. A broadcast leads
  /// to the contributions of its entry method, and of the coroutines and messages between elements
  /// of the array that follow from it. Where rounds overlap (a broadcast is started before the
  /// result of the last one is known), insert elements while none is under way.
  template <class Op, class T>
  void contribute(Op op, T value, Callback<T> target) {
    Contribution::give(index(), *this, op, std::move(value), std::move(target));
  }
};

}  // namespace tess
