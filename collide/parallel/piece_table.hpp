// Long thin objects in pieces (problem/thin_objects.hpp): for each box of a list, the object of
// which it is a piece. What a voxel knows of the whole object is enough to make all its pieces
// again.
#pragma once

#include "collide/capsule.hpp"
#include "collide/problem/slim_capsule.hpp"
#include "collide/problem/thin_objects.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tess::collide {

class PieceTable {
 public:
  /// A whole object.
  struct Object {
    Aabb box;
    Capsule capsule;
    std::uint64_t number = 0;  ///< its PE and its position there: no other in a collision has it
    std::int32_t n_pieces = 1;
    std::int32_t unused = 0;
  };

  /// Boxes that are added next are pieces of this object. Its capsule is also stored in eight
  /// floats.
  void add_object(const Object& object, const search::Frame& frame) {
    objects_.push_back(object);
    capsules_.push_back(search::slim(object.capsule, frame));
  }
  /// The number of the piece among those of its object.
  void add_piece(std::uint32_t number) {
    const auto last = static_cast<std::uint32_t>(objects_.size() - 1);
    pieces_.push_back({last, number, objects_.back().number});
  }
  /// A box of another list. Pieces of an object that follow each other share it.
  void append(const PieceTable& from, std::uint32_t box) {
    const Piece piece = from.pieces_[box];
    const Object& object = from.objects_[piece.object];
    if (objects_.empty() || objects_.back().number != object.number) {
      objects_.push_back(object);
      capsules_.push_back(from.capsules_[piece.object]);
    }
    add_piece(piece.number);
  }
  void clear() {
    objects_.clear();
    capsules_.clear();
    pieces_.clear();
  }

  [[nodiscard]] bool empty() const noexcept { return pieces_.empty(); }

  // What search::PiecePairs needs (problem/piece_pairs.hpp).
  using Boxes = search::BoxesOfPieces<double>;
  [[nodiscard]] static constexpr bool in_pieces() noexcept { return true; }
  /// The position of a box's object among the objects and capsules.
  [[nodiscard]] std::uint32_t object_of(std::uint32_t box) const noexcept {
    return pieces_[box].object;
  }
  [[nodiscard]] std::uint32_t number_of(std::uint32_t box) const noexcept {
    return pieces_[box].number;
  }
  /// Object::number of the box's object.
  [[nodiscard]] std::uint64_t number_of_object(std::uint32_t box) const noexcept {
    return pieces_[box].number_of_object;
  }
  [[nodiscard]] const Aabb& box_of_object(std::uint32_t at) const noexcept {
    return objects_[at].box;
  }
  /// They are made in `memory`.
  [[nodiscard]] std::span<const Aabb> pieces_of(std::uint32_t at, Boxes& memory) const noexcept {
    const Object& of = objects_[at];
    return {memory.data(), search::cut(of.box, of.capsule, of.n_pieces, memory.data())};
  }
  [[nodiscard]] const search::SlimCapsule* capsules() const noexcept { return capsules_.data(); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(objects_, capsules_, pieces_);
  }

 private:
  struct Piece {
    std::uint32_t object = 0, number = 0;
    std::uint64_t number_of_object = 0;  // beside it: most pairs are told apart by it
  };

  std::vector<Object> objects_;
  std::vector<search::SlimCapsule> capsules_;  // of the objects
  std::vector<Piece> pieces_;                  // one per box of the list
};

}  // namespace tess::collide
