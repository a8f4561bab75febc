// The couplings that a piece is part of, and what both kinds of piece need to find each other.
#pragma once

#include "m2m/parallel/overlap_source.hpp"
#include "m2m/parallel/overlap_target.hpp"
#include "m2m/parallel/source_side.hpp"
#include "m2m/parallel/target_side.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/runtime.hpp"

#include <map>
#include <span>
#include <string_view>
#include <type_traits>

namespace tess::m2m {

namespace detail {

/// The two sides of a collision, as models.
inline constexpr collide::ModelId source_model{1};
inline constexpr collide::ModelId target_model{2};

/// A chare's values: of its accessor, which may take the coupling, or in its public member vector.
template <auto F, class C>
auto values_of(C& chare, CouplingId coupling) {
  if constexpr (std::is_member_object_pointer_v<decltype(F)>) {
    return std::span(chare.*F);
  } else if constexpr (std::is_invocable_v<decltype(F), C&, CouplingId>) {
    return (chare.*F)(coupling);
  } else {
    return (chare.*F)();
  }
}

/// A piece of class C by its owner id.
template <class C>
auto piece_of(CollectionId array, collide::OwnerId piece) {
  return ArrayProxy<C>(array)[collide::index_of<typename C::Index>(piece)];
}

/// The channel of values for Take.
template <auto Take>
std::uint64_t channel_of() {
  const std::string_view key = naming::name_of<Take>().key;
  return hash_bytes(key.data(), key.size());
}

}  // namespace detail

/// The couplings of a piece. It migrates with the piece.
struct Couplings {
  std::map<CouplingId, SourceSide> sources{};
  std::map<CouplingId, TargetSide> targets{};
  std::map<CouplingId, OverlapSource> overlap_sources{};
  std::map<CouplingId, OverlapTarget> overlap_targets{};

  [[nodiscard]] bool is_conservative_source(CouplingId id) const {
    return overlap_sources.contains(id);
  }
  [[nodiscard]] bool is_conservative_target(CouplingId id) const {
    return overlap_targets.contains(id);
  }
  [[nodiscard]] SourceSide& source(CouplingId id);
  [[nodiscard]] TargetSide& target(CouplingId id);
  [[nodiscard]] const TargetSide& target(CouplingId id) const;
  [[nodiscard]] OverlapSource& overlap_source(CouplingId id) { return overlap_sources.at(id); }
  [[nodiscard]] OverlapTarget& overlap_target(CouplingId id) { return overlap_targets.at(id); }
  [[nodiscard]] const OverlapTarget& overlap_target(CouplingId id) const {
    return overlap_targets.at(id);
  }
  void release(CouplingId id);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(sources, targets, overlap_sources, overlap_targets);
  }
};

}  // namespace tess::m2m
