// An array of pieces whose class is not known.
#pragma once

#include "collide/hit_receivers.hpp"
#include "m2m/couple/any_piece.hpp"
#include "runtime/more/interface.hpp"

#include <type_traits>
#include <utility>
#include <variant>

namespace tess::m2m {

/// Its index has one to three dimensions. F of the functions is an entry method of AnyPiece.
class PieceArray {
 public:
  PieceArray() = default;
  template <class C>
  explicit PieceArray(const ArrayProxy<C>& array)
      : array_(InterfaceArray<AnyPiece, typename C::Index>(array)) {}

  [[nodiscard]] CollectionId id() const {
    return std::visit([](const auto& array) { return array.id(); }, array_);
  }
  template <auto F, class... Args>
  void broadcast(const Args&... args) const {
    std::visit([&](const auto& array) { array.template broadcast<F>(args...); }, array_);
  }
  template <auto F, class... Args>
  void send(collide::OwnerId piece, Args&&... args) const {
    std::visit(
        [&](const auto& array) {
          using Index = typename std::decay_t<decltype(array)>::Index;
          array[collide::index_of<Index>(piece)].template send<F>(std::forward<Args>(args)...);
        },
        array_);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(array_);
  }

 private:
  std::variant<InterfaceArray<AnyPiece, Index1>, InterfaceArray<AnyPiece, Index2>,
               InterfaceArray<AnyPiece, Index3>>
      array_;
};

template <auto F, class Message>
void AnyPiece::m2m_send(const PieceArray& pieces, collide::OwnerId to, Message message) {
  message.from = m2m_owner();
  pieces.send<F>(to, std::move(message));
}

}  // namespace tess::m2m
