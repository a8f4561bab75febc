// Reports hits to the owners of the objects. A voxel sends its hits directly to the chares that own
// the objects, in one message per pair of owners. The complete list of hits is never in one place.
#pragma once

#include "collide/hit.hpp"
#include "collide/owner.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <optional>
#include <utility>
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

/// Says how many owners of a pair receive it. An owner of both objects receives it once, and `mine`
/// is either of them.
enum class Receivers {
  both_owners,
  /// One of the two. If an object of the pair was submitted on the PE that finds the pair, it is
  /// the owner of this object, so most pairs stay on their PE and each PE has its share. Which one
  /// it is may differ from run to run.
  one_owner
};

/// The receivers of hits.
struct HitReceivers {
  Callback<Hits> call;  ///< called per (voxel, owner, other) with hits
  /// If set, the owner of the object of this model receives a hit, and `receivers` has no effect.
  /// If both objects are of this model, both owners receive it, or the owner of both once. If
  /// neither is, it is not sent.
  std::optional<ModelId> only;
  Receivers receivers = Receivers::both_owners;

  /// They have a constructor because g++ 12 destroys an aggregate twice that is written in a
  /// co_await expression.
  // NOLINTNEXTLINE(google-explicit-constructor)
  HitReceivers(Callback<Hits> call_ = {}, std::optional<ModelId> only_ = {},
               Receivers receivers_ = Receivers::both_owners)
      : call(std::move(call_)), only(only_), receivers(receivers_) {}

  template <class Ar>
  void serialize(Ar& ar) {
    ar(call, only, receivers);
  }
};

namespace detail {
template <class C, auto F>
void call_owner(const Callback<Hits>& callback, Hits&& hits) {
  const ArrayProxy<C> owners(from_bytes<CollectionId>(callback.where()));
  try {
    owners[index_of<typename C::Index>(hits.owner)].template send<F>(std::move(hits));
  } catch (const Error& error) {
    fail(error.code(), "report_to() ", plain_name(name_of_type<C>), ": ", error.what());
  }
}
template <class C, auto F>
inline const Callback<Hits>::Kind owner_kind{naming::name_of<&call_owner<C, F>>(),
                                             &call_owner<C, F>};
}  // namespace detail

/// Sends hits to the entry method F(Hits) of the elements of an array, or of a group's members. An
/// object of an element has the owner id owner_of(index); one of a member owner_of(pe).
template <auto F, class C>
[[nodiscard]] Callback<Hits> report_to(const ArrayProxy<C>& owners) {
  return Callback<Hits>(detail::owner_kind<C, F>, to_bytes(owners.id()));
}

}  // namespace tess::collide
