// Reports hits to the owners of the objects. A voxel sends its hits directly to the chares that own
// the objects, in one message per pair of owners. The complete list of hits is never in one place.
#pragma once

#include "collide/hit.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tess::collide {

/// A hit between an object of the receiving owner and an object of the other owner.
struct LocalPair {
  LocalId mine{};
  LocalId theirs{};
  friend auto operator<=>(const LocalPair&, const LocalPair&) = default;
};

/// Hits between two owners, found in one voxel.
struct Hits {
  OwnerId owner{};  ///< the receiver
  OwnerId other{};
  std::vector<LocalPair> pairs;
};

/// The receivers of hits.
struct Report {
  Callback<Hits> call;  ///< called per (voxel, owner, other) with hits
  /// If set, only the owner of the object of this model receives a hit; otherwise both owners do.
  std::optional<ModelId> only;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(call, only);
  }
};

/// The owner id of an element of a one-dimensional array, for report_to().
[[nodiscard]] inline OwnerId owner_of(Index1 index) {
  return static_cast<OwnerId>(static_cast<std::uint32_t>(index.x));
}
[[nodiscard]] inline Index1 index_of(OwnerId owner) {
  return Index1{static_cast<std::int32_t>(static_cast<std::uint64_t>(owner))};
}

namespace detail {
template <class C, auto F>
void call_owner(const Callback<Hits>& callback, Hits&& hits) {
  const ArrayProxy<C> owners(from_bytes<CollectionId>(callback.where()));
  const Index1 owner = index_of(hits.owner);
  owners[owner].template send<F>(std::move(hits));
}
template <class C, auto F>
inline const Callback<Hits>::Kind owner_kind{naming::name_of<&call_owner<C, F>>(),
                                             &call_owner<C, F>};
}  // namespace detail

/// Sends hits to the entry method F(Hits) of the elements of an array. An object of an element has
/// the owner id owner_of(index).
template <auto F, class C>
[[nodiscard]] Callback<Hits> report_to(const ArrayProxy<C>& owners) {
  return Callback<Hits>(detail::owner_kind<C, F>, to_bytes(owners.id()));
}

}  // namespace tess::collide
