// Groups: one member on each PE, until destroy() or the end of the run. class Manager : public
// tess::Group<Manager> { … }; Messages go to the member on a PE; the member on this PE is an
// ordinary object to its neighbours: proxy.local().
//
// A group is an array whose elements have the numbers of the PEs and stay there.
#pragma once

#include "runtime/array.hpp"

namespace tess {

template <class G>
class GroupProxy;

/// The base of a group's members.
template <class Derived>
class Group : public IndexedElement<Index1> {
 public:
  using Index = Index1;
  /// For Array: the element of index i is on PE i, and there is one on each.
  static constexpr bool one_per_pe = true;
  [[nodiscard]] static PeId place(const Index1& index, std::int32_t /*n_pes*/) {
    return PeId{index.x};
  }

  [[nodiscard]] PeId pe() const { return PeId{this->index_.x}; }
  /// The group this is a member of.
  [[nodiscard]] GroupProxy<Derived> group() const {
    return GroupProxy<Derived>(this->collection_id());
  }

  /// Gives this member's value to the next reduction of the group; every member gives one.
  /// in_order(op) combines in the order of PEs.
  template <class Op, class T>
  void contribute(Op op, T value, Callback<T> target) {
    Contribution::give(this->index_, *this, op, std::move(value), std::move(target));
  }
};

/// The member of a group on one PE.
template <class G>
class MemberProxy {
 public:
  MemberProxy(CollectionId id, PeId pe) : id_(id), pe_(pe) {}

  template <auto F, class... Args>
  void send(Args&&... args) const {
    check_exists(current_pe(), pe_);
    member().template send<F>(std::forward<Args>(args)...);
  }

  [[nodiscard]] PeId next_pe() const { return pe_; }

  /// A target for results: entry method F of this member.
  template <auto F>
  [[nodiscard]] auto target() const {
    return member().template target<F>();
  }

 private:
  [[nodiscard]] ElementProxy<G> member() const { return {id_, Index1{pe_.value}}; }

  CollectionId id_;
  PeId pe_;
};

/// A whole group.
template <class G>
class GroupProxy {
 public:
  GroupProxy() = default;
  explicit GroupProxy(CollectionId id) : id_(id) {}

  [[nodiscard]] CollectionId id() const { return id_; }
  [[nodiscard]] MemberProxy<G> operator[](PeId pe) const { return MemberProxy<G>(id_, pe); }

  /// The member on this PE, or null where the group is not known yet or was destroyed.
  [[nodiscard]] G* local_or_null() const {
    const Collection* collection = find_collection(current_pe(), id_);
    return collection == nullptr || collection->n_local() == 0
               ? nullptr
               : static_cast<G*>(collection->elements().front());
  }
  /// The member on this PE.
  [[nodiscard]] G& local() const {
    G* member = local_or_null();
    TESS_CHECK(member != nullptr, "this group ",
               current_pe().ended(id_) ? "was destroyed" : "is not known yet", " on ",
               current_pe().id());
    return *member;
  }

  /// Calls entry method F of every member.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    ArrayProxy<G>(id_).template broadcast<F>(std::forward<Args>(args)...);
  }

  /// Ends the group: on every PE its member is destroyed and all that it holds is freed. What is
  /// still under way to it is dropped where it arrives; messages and broadcasts count as dead
  /// letters. A member whose coroutine waits gets no more messages, and ends once the coroutine is
  /// done. The epoch that runs waits until all PEs have freed the group. The second end of a group
  /// does nothing.
  void destroy() const { end_collection(id_); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_);
  }

 private:
  CollectionId id_{};
};

/// Creates a group: one G on each PE, made with these arguments. Returns at once.
template <class G, class... Args>
GroupProxy<G> create_group(Args&&... args) {
  return GroupProxy<G>(
      detail::create_collection<G>(range(current_pe().n_pes()), std::forward<Args>(args)...));
}

}  // namespace tess
