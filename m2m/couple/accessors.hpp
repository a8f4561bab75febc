// How a coupling reads the values of a chare, or writes to its memory: a member of the chare's
// class that shows them, as a value in messages.
#pragma once

#include "m2m/couple/couplings.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/registered_pointer.hpp"

#include <span>
#include <string_view>
#include <type_traits>

namespace tess::m2m {

class AnyPiece;

namespace detail {

/// One static object for each class and member.
template <class Number>
struct AccessorKind : tess::detail::Registered {
  using Show = std::span<Number> (*)(AnyPiece&, CouplingId);
  AccessorKind(naming::Name name, Show show_)
      : Registered(name), show(show_), channel(hash_bytes(name.key().data(), name.key().size())) {}
  Show show;
  std::uint64_t channel;  ///< for messages to this member
};
/// Shows what a piece gives: a row per point, tetrahedron or corner, as the coupling's
/// source_values say.
using Giver = tess::detail::RegisteredPointer<AccessorKind<const double>>;
/// Shows where a piece takes values: a row per point that it owns, or per cell.
using Taker = tess::detail::RegisteredPointer<AccessorKind<double>>;

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

template <class C, auto Give>
struct GiverOf {
  static std::span<const double> show(AnyPiece& piece, CouplingId coupling) {
    C& chare = static_cast<C&>(piece);
    static_assert(
        ShowsMemory<decltype(call_accessor<Give>(chare, coupling)), std::span<const double>>,
        "a coupling gives values that the chare keeps: return std::span<const double>, not "
        "a vector, which would end before it is read");
    return call_accessor<Give>(chare, coupling);
  }
  static inline const AccessorKind<const double> kind{naming::name_of<GiverOf>(), &show};
};
template <class C, auto Take>
struct TakerOf {
  static std::span<double> show(AnyPiece& piece, CouplingId coupling) {
    C& chare = static_cast<C&>(piece);
    static_assert(ShowsMemory<decltype(call_accessor<Take>(chare, coupling)), std::span<double>>,
                  "a coupling takes values into memory of the chare: return std::span<double>");
    return call_accessor<Take>(chare, coupling);
  }
  static inline const AccessorKind<double> kind{naming::name_of<TakerOf>(), &show};
};

}  // namespace detail

}  // namespace tess::m2m
