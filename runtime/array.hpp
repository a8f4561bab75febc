// Arrays of chares and their proxies. A proxy is a small value: it can be stored, sent, and used on
// every PE.
//
//     // dense: 64 elements, each Block(size)
//     auto blocks = tess::create<Block>(tess::range(8, 8), size);
//     // sparse: elements exist once they are inserted or demanded
//     auto voxels = tess::create<Voxel>(tess::sparse);
//     blocks[{3, 4}].send<&Block::step>(0);
//     blocks.broadcast<&Block::step>(0);
#pragma once

#include "runtime/array_proxy.hpp"
#include "runtime/chare.hpp"
#include "runtime/pe/to_all.hpp"

#include <concepts>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {

template <class C, class... Args>
struct CreateArray {
  CollectionId id;
  Range range;
  std::tuple<Args...> args;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id, range, args);
  }
};

/// Makes the part of an array on this PE, with its initial elements.
template <class C, class... Args>
void make_array(Pe& pe, const CreateArray<C, Args...>& m,
                const std::shared_ptr<const IndexMap>& map = nullptr) {
  auto& array =
      static_cast<Array<C>&>(add_collection(pe, Array<C>::its_kind(), m.id, m.range, map));
  std::apply([&array](const Args&... args) { array.make_initial(args...); }, m.args);
}
template <class C, class... Args>
void create_arrives(Pe& pe, CreateArray<C, Args...>&& m, Counted /*counted*/) {
  make_array(pe, m);
}

/// What happens to messages to an ended collection of C: they count as dead letters, unless the
/// class defines late_messages.
template <class C>
constexpr LateMessages late_messages_of() {
  if constexpr (requires { C::late_messages; }) {
    return C::late_messages;
  } else {
    return LateMessages::counted;
  }
}

template <class C, class... Args>
CreateArray<C, std::decay_t<Args>...> new_array(Pe& pe, const Range& range, Args&&... args) {
  return {pe.collections().new_id(late_messages_of<C>()), range, {std::forward<Args>(args)...}};
}

template <class C, class... Args>
CollectionId create_collection(const Range& range, Args&&... args) {
  Pe& pe = current_pe();
  auto array = new_array<C>(pe, range, std::forward<Args>(args)...);
  const CollectionId id = array.id;
  // It is made here at once, so that the proxy is valid from now on.
  send_to_all<&create_arrives<C, std::decay_t<Args>...>>(pe, std::move(array));
  return id;
}

/// Checks the class of create().
template <class C>
consteval void check_class() {
  static_assert(!std::is_base_of_v<Element, C> || std::is_convertible_v<C*, Element*>,
                "derive publicly from tess::Chare: class C : public tess::Chare<C, Index>");
  static_assert(IsChare<C>, "create<C>() needs a class C that derives from tess::Chare<C, Index>");
  if constexpr (IsChare<C>)
    static_assert(std::equality_comparable<typename C::Index>,
                  "indices are compared: give the type of the index a defaulted operator==");
  static_assert(!OnePerPe<C>, "a group has one member per PE: create<G>(tess::each_pe, …)");
}

/// Checks the arguments of create().
template <class C, class... Args>
void check_creation(const Range& range) {
  check_class<C>();
  // Without coordinates there are no initial elements, and insert() has its own arguments.
  static_assert(
      (!Coordinates<typename C::Index> && sizeof...(Args) == 0) ||
          std::is_constructible_v<C, const std::decay_t<Args>&...>,
      "the chare has no constructor that takes these arguments (each element gets a copy)");
  if constexpr (Coordinates<typename C::Index>) {
    TESS_CHECK(range.n_axes == 0 || range.n_axes == n_axes_of<typename C::Index>, "a range of ",
               range.n_axes, " axes for an index of ", n_axes_of<typename C::Index>);
  } else {
    TESS_CHECK(range.n_axes == 0,
               "an array with this type of index starts sparse: create<C>(tess::sparse)");
  }
}

}  // namespace detail

/// Creates an array on all PEs. Each element of the range is constructed with these arguments on
/// the home PE of its index. Returns immediately: messages wait on PEs that do not know the array
/// yet.
template <class C, class... Args>
ArrayProxy<C> create(const Range& range, Args&&... args) {
  if constexpr (detail::IsChare<C>)
    static_assert(Coordinates<typename C::Index>,
                  "an array with this type of index starts sparse: create<C>(tess::sparse)");
  detail::check_creation<C, Args...>(range);
  return ArrayProxy<C>(detail::create_collection<C>(range, std::forward<Args>(args)...));
}
/// Creates a sparse array, which has no elements yet. insert() has the arguments of constructors.
template <class C>
ArrayProxy<C> create(const Sparse& range) {
  detail::check_class<C>();
  return ArrayProxy<C>(detail::create_collection<C>(range));
}

}  // namespace tess
