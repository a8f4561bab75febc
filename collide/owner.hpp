// The ids of owners that are elements of arrays of one to three dimensions, or members of a group:
// hit_receivers.hpp sends them their hits. An id also says how many dimensions its index has, so that
// one which reaches another array is refused.
//
//     dimensions   bits from the top
//     1            0…0, 32 of x
//     2            01, 31 of x, 31 of y
//     3            1, 21 of x, 21 of y, 21 of z
#pragma once

#include "collide/hit.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/core/index.hpp"

#include <concepts>
#include <cstdint>
#include <string>

namespace tess::collide {

/// The owner id of an element. Throws Error (bad_value) for a coordinate that has more bits.
[[nodiscard]] inline OwnerId owner_of(const Index1& index) {
  return static_cast<OwnerId>(static_cast<std::uint32_t>(index.x));
}
[[nodiscard]] OwnerId owner_of(const Index2& index);
[[nodiscard]] OwnerId owner_of(const Index3& index);
/// The owner id of a group's member.
[[nodiscard]] inline OwnerId owner_of(PeId pe) {
  return owner_of(Index1{pe.value});
}

/// An index that an owner id can hold.
template <class Index>
concept CanOwn =
    std::same_as<Index, Index1> || std::same_as<Index, Index2> || std::same_as<Index, Index3>;

/// "[3,4]": the index.
[[nodiscard]] std::string owner_text(OwnerId owner);

namespace detail {
void set_index(Index1& index, OwnerId owner);
void set_index(Index2& index, OwnerId owner);
void set_index(Index3& index, OwnerId owner);
}  // namespace detail

/// The index that owner_of() was given. Throws Error (bad_value) if it has other dimensions.
template <class Index = Index1>
[[nodiscard]] Index index_of(OwnerId owner) {
  static_assert(CanOwn<Index>,
                "an owner of objects is an element of an array of one to three dimensions");
  Index index;
  detail::set_index(index, owner);
  return index;
}

}  // namespace tess::collide
