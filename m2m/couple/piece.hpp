// A chare that holds a piece of a mesh, as couplings (coupling.hpp) use it.
#pragma once

#include "collide/hit_receivers.hpp"
#include "m2m/couple/any_piece.hpp"
#include "runtime/runtime.hpp"

#include <concepts>

namespace tess::m2m {

template <class C>
class Piece;

namespace detail {
template <class C>
concept ShowsMesh = requires(const C& chare) {
  { chare.mesh_view() } -> std::same_as<MeshView>;
};

/// Checks that couplings can use chares of C.
template <class C>
consteval bool check_piece() {
  static_assert(std::derived_from<C, Piece<C>> && ShowsMesh<C>,
                "a chare of a coupling derives from tess::m2m::Piece<of itself>, and has a public "
                "member function MeshView mesh_view() const");
  static_assert(collide::CanOwn<typename C::Index>,
                "the pieces of a coupling are elements of arrays of one to three dimensions");
  return true;
}
}  // namespace detail

/// A second base class of a chare that holds a piece of a mesh. The chare has a member function
/// `MeshView mesh_view() const`; if it migrates, it serialises `couplings`. If it has a member
/// function `received(CouplingId)`, that is called after new values were written: once per round,
/// also if the piece has no point or no point got a value.
template <class C>
class Piece : public AnyPiece {
 public:
  /// Gives the values that Give shows to the pieces of the coupling's target, which are of class
  /// T: Take of each shows the memory that they go to. The k-th call of every source piece belongs
  /// to the k-th round; a target piece gets a round when it is complete, and one with points that
  /// no source piece reaches gets the values of the policy. Give may be const. An apply() of the
  /// coupling to the same Take is a round, too: call it when no other round is under way.
  template <class T, auto Give, auto Take>
  void m2m_give(CouplingId id) {
    m2m_give_round(id, detail::Giver(detail::GiverOf<C, Give>::kind),
                   detail::Taker(detail::TakerOf<T, Take>::kind));
  }

 protected:
  Piece() = default;

 private:
  [[nodiscard]] const C& m2m_chare() const { return static_cast<const C&>(*this); }
  [[nodiscard]] MeshView m2m_view() const final {
    static_assert(detail::check_piece<C>());
    return m2m_chare().mesh_view();
  }
  [[nodiscard]] collide::OwnerId m2m_owner() const final {
    return collide::owner_of(m2m_chare().index());
  }
  void m2m_received(CouplingId id) final {
    if constexpr (requires(C& of_user) { of_user.received(id); })
      static_cast<C&>(*this).received(id);
  }
};

}  // namespace tess::m2m
