// Groups: one member on each PE, until destroy() or the end of the run.
//
//     class Manager : public tess::Group<Manager> { … };
//     auto managers = tess::create<Manager>(tess::each_pe, args…);
//
// Messages go to the member on a PE. For code on the same PE the member is an ordinary object:
// managers.local().
//
// A group is an array whose elements are numbered by PE and do not move.
#pragma once

#include "runtime/array.hpp"

namespace tess {

/// The proxy of a whole group: managers[pe] is the member on a PE, managers.local() the one here.
template <class G>
using GroupProxy = ArrayProxy<G>;
/// The proxy of a group's member on one PE.
template <class G>
using MemberProxy = ElementProxy<G, Index1>;

/// The base class of a group's members.
template <class Derived>
class Group : public detail::TessContributor<Index1> {
 public:
  using Index = Index1;
  /// Array reads it: there is one element per PE, and the element with index i is on PE i.
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

/// Says where the elements of create() are: one on each PE.
struct EachPe {};
inline constexpr EachPe each_pe{};

/// Creates a group: one G per PE, constructed with these arguments. Returns immediately.
template <class G, class... Args>
GroupProxy<G> create(EachPe /*where*/, Args&&... args) {
  static_assert(detail::OnePerPe<G>,
                "a group's class derives from tess::Group; create<C>(range) makes an array");
  return GroupProxy<G>(
      detail::create_collection<G>(range(current_pe().n_pes()), std::forward<Args>(args)...));
}
template <class G, class... Args>
[[deprecated("create<G>(tess::each_pe, …)")]] GroupProxy<G> create_group(Args&&... args) {
  return create<G>(each_pe, std::forward<Args>(args)...);
}

}  // namespace tess
