// What a collision tells the owners of objects, and how: pieces of the list of hits go straight
// from the voxel that found them to the chare that owns the object. Nobody ever holds the whole
// list.
#pragma once

#include "collide/hit.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace tess::collide {

/// One hit between an object of the owner that is told and an object of the other.
struct LocalPair {
  LocalId mine{};
  LocalId theirs{};
  friend auto operator<=>(const LocalPair&, const LocalPair&) = default;
};

/// Hits between two owners, found in one voxel.
struct Hits {
  OwnerId owner{};  ///< who is told
  OwnerId other{};
  std::vector<LocalPair> pairs;
};

/// Who is told of a hit.
struct Report {
  Callback<Hits> call;  ///< called for each (voxel, owner, other) that has hits
  std::optional<ModelId>
      only;  ///< tell the owner of the object of this model alone; otherwise both owners

  template <class Ar>
  void serialize(Ar& ar) {
    ar(call, only);
  }
};

/// The owner id of an element of a one-dimensional array; report_to() finds the element by it.
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
inline const Callback<Hits>::Kind owner_kind{naming::value<&call_owner<C, F>>(), &call_owner<C, F>};
}  // namespace detail

/// Hits go to entry method F(Hits) of the elements of an array whose objects carry owner_of(index).
template <auto F, class C>
[[nodiscard]] Callback<Hits> report_to(const ArrayProxy<C>& owners) {
  return Callback<Hits>(detail::owner_kind<C, F>, to_bytes(owners.id()));
}

}  // namespace tess::collide
