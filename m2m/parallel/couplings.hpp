// The couplings that a piece is part of, and what both kinds of piece need to find each other.
#pragma once

#include "m2m/parallel/overlap_source.hpp"
#include "m2m/parallel/overlap_target.hpp"
#include "m2m/parallel/source_side.hpp"
#include "m2m/parallel/target_side.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/runtime.hpp"

#include <map>
#include <ranges>
#include <span>
#include <string_view>
#include <type_traits>

namespace tess::m2m {

namespace detail {

/// The two sides of a collision, as models.
inline constexpr collide::ModelId source_model{1};
inline constexpr collide::ModelId target_model{2};

/// A chare's public member, or what its accessor returns, which may take the coupling.
template <auto F, class C>
decltype(auto) call_accessor(C& chare, CouplingId coupling) {
  if constexpr (std::is_member_object_pointer_v<decltype(F)>) {
    return (chare.*F);
  } else if constexpr (std::is_invocable_v<decltype(F), C&, CouplingId>) {
    return (chare.*F)(coupling);
  } else {
    static_assert(std::is_invocable_v<decltype(F), C&>,
                  "an accessor to a coupling's values takes nothing, or the CouplingId");
    return (chare.*F)();
  }
}
template <class Result, class Span>
concept ShowsMemory = std::ranges::borrowed_range<Result> && std::is_convertible_v<Result, Span>;

/// The values that a chare gives.
template <auto Give, class C>
std::span<const double> values_of(C& chare, CouplingId coupling) {
  static_assert(
      ShowsMemory<decltype(call_accessor<Give>(chare, coupling)), std::span<const double>>,
      "a coupling gives values that the chare keeps: return std::span<const double>, not "
      "a vector, which would end before it is read");
  return call_accessor<Give>(chare, coupling);
}
/// The memory of a chare that takes values.
template <auto Take, class C>
std::span<double> memory_of(C& chare, CouplingId coupling) {
  static_assert(ShowsMemory<decltype(call_accessor<Take>(chare, coupling)), std::span<double>>,
                "a coupling takes values into memory of the chare: return std::span<double>");
  return call_accessor<Take>(chare, coupling);
}

/// A piece of class C by its owner id.
template <class C>
auto piece_of(CollectionId array, collide::OwnerId piece) {
  return ArrayProxy<C>(array)[collide::index_of<typename C::Index>(piece)];
}

/// The channel of values for Take.
template <auto Take>
std::uint64_t channel_of() {
  const std::string_view key = naming::name_of<Take>().key();
  return hash_bytes(key.data(), key.size());
}

/// Ends the job if a handle cannot be used: it has no arrays, an array has ended, or a copy of the
/// handle has destroyed the coupling. `use`: "searched" or "applied".
void require_usable(const CouplingSetup& setup, CollectionId source, CollectionId target,
                    const char* use);

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
  [[nodiscard]] OverlapSource& overlap_source(CouplingId id);
  [[nodiscard]] OverlapTarget& overlap_target(CouplingId id);
  [[nodiscard]] const OverlapTarget& overlap_target(CouplingId id) const;
  void release(CouplingId id);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(sources, targets, overlap_sources, overlap_targets);
  }
};

}  // namespace tess::m2m
