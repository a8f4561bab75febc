// Groups: one member on each PE, until destroy() or the end of the run.
//
//     class Manager : public tess::Group<Manager> { … };
//     auto managers = tess::create_group<Manager>(args…);
//
// Messages go to the member on a PE. For code on the same PE the member is an ordinary object:
// managers.local().
//
// A group is an array whose elements are numbered by PE and do not move.
#pragma once

#include "runtime/array.hpp"

namespace tess {

template <class G>
class GroupProxy;

/// The base class of a group's members.
template <class Derived>
class Group : public detail::TessContributor<Index1> {
 public:
  using Index = Index1;
  /// For Array: there is one element per PE, and the element with index i is on PE i.
  static constexpr bool one_per_pe = true;
  [[nodiscard]] static PeId place(const Index1& index, std::int32_t /*n_pes*/) {
    return PeId{index.x};
  }

  [[nodiscard]] PeId pe() const { return PeId{this->index_.x}; }
  /// The group of this member.
  [[nodiscard]] GroupProxy<Derived> group() const {
    return GroupProxy<Derived>(this->collection_id());
  }

  /// Contributes this member's value to the next reduction of the group; every member contributes
  /// one value. in_order(op) combines the values in the order of PEs.
  using detail::TessContributor<Index1>::contribute;
};

/// The proxy of a group's member on one PE.
template <class G>
class MemberProxy {
 public:
  /// Of no member: it can only be assigned to.
  MemberProxy() = default;
  MemberProxy(CollectionId id, PeId pe) : id_(id), pe_(pe) {}

  template <auto F, class... Args>
  void send(Args&&... args) const {
    detail::check_exists(current_pe(), pe_);
    member().template send<F>(std::forward<Args>(args)...);
  }

  /// The same member for messages with a priority.
  [[nodiscard]] PrioritisedElement<G, Index1> with(Priority priority) const {
    detail::check_exists(current_pe(), pe_);
    return member().with(priority);
  }
  /// As ElementProxy::send_after().
  template <auto F, class... Args>
  Timer send_after(std::chrono::nanoseconds delay, Args&&... args) const {
    detail::check_exists(current_pe(), pe_);
    return member().template send_after<F>(delay, std::forward<Args>(args)...);
  }
  /// As ElementProxy::ask().
  template <auto F, class... Args>
  [[nodiscard]] Ask<G, F> ask(Args&&... args) const {
    detail::check_exists(current_pe(), pe_);
    return member().template ask<F>(std::forward<Args>(args)...);
  }

  [[nodiscard]] PeId next_pe() const { return pe_; }

  /// A target for results: entry method F of this member.
  template <auto F>
  [[nodiscard]] auto target() const {
    return member().template target<F>();
  }

  friend auto operator<=>(const MemberProxy&, const MemberProxy&) = default;
  [[nodiscard]] std::size_t hash() const { return member().hash(); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_, pe_);
  }

 private:
  [[nodiscard]] ElementProxy<G, Index1> member() const { return {id_, Index1{pe_.value}}; }

  CollectionId id_{};
  PeId pe_{};
};

/// The proxy of a whole group.
template <class G>
class GroupProxy : public detail::WholeHandle<GroupProxy<G>> {
 public:
  using detail::WholeHandle<GroupProxy>::WholeHandle;

  [[nodiscard]] MemberProxy<G> operator[](PeId pe) const { return MemberProxy<G>(id_, pe); }

  /// The member on this PE; null if the group is not known here yet or was destroyed.
  [[nodiscard]] G* local_or_null() const {
    const detail::Collection* collection = detail::find_collection(current_pe(), id_);
    return collection == nullptr || collection->n_local() == 0
               ? nullptr
               : static_cast<G*>(collection->elements().front());
  }
  /// The member on this PE.
  [[nodiscard]] G& local() const {
    G* member = local_or_null();
    if (member == nullptr) [[unlikely]]
      detail::refuse_absent(id_, "this group", "");
    return *member;
  }

  /// Calls entry method F of every member.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    ArrayProxy<G>(id_).template broadcast<F>(std::forward<Args>(args)...);
  }
  /// As ArrayProxy::reduce().
  template <auto F, class... Args>
  [[nodiscard]] detail::FutureOf<F> reduce(Args&&... args) const {
    return detail::reduce<F>(*this, std::forward<Args>(args)...);
  }
  /// A target for results: entry method F of all members.
  template <auto F>
  [[nodiscard]] auto target() const {
    return ArrayProxy<G>(id_).template target<F>();
  }
  /// The same group for broadcasts with a priority.
  [[nodiscard]] PrioritisedArray<G> with(Priority priority) const {
    return ArrayProxy<G>(id_).with(priority);
  }

  /// Ends the group: on every PE its member is destroyed and its memory is freed. Messages that are
  /// still under way to it are dropped where they arrive; messages and broadcasts count as dead
  /// letters. A member with a waiting coroutine gets no more messages and is destroyed once the
  /// coroutine is done. The current epoch waits until all PEs have freed the group. Ending a group
  /// again has no effect.
  void destroy() const { detail::end_collection(id_); }

 private:
  using detail::WholeHandle<GroupProxy>::id_;
};

/// Creates a group: one G per PE, constructed with these arguments. Returns immediately.
template <class G, class... Args>
GroupProxy<G> create_group(Args&&... args) {
  static_assert(detail::OnePerPe<G>,
                "a group's class derives from tess::Group; create() makes an array");
  return GroupProxy<G>(
      detail::create_collection<G>(range(current_pe().n_pes()), std::forward<Args>(args)...));
}

}  // namespace tess

template <class G>
struct std::hash<tess::MemberProxy<G>> : tess::detail::HashOfHandle {};
template <class G>
struct std::hash<tess::GroupProxy<G>> : tess::detail::HashOfHandle {};
