// Long thin objects: their boxes are mostly empty, so of the pairs of boxes hardly any is a pair of
// objects. Their capsules (capsule.hpp) tell most of them apart. If the boxes are so long that too
// many of them overlap, the objects are divided along their capsules into pieces, each with a box
// of its own: what is searched then is near the object, not near its box.
//
//     +---------+            +--+
//     |        /|            | /+--+
//     |     /   |   pieces:  +--+ /|--+
//     |  /      |               +--+/ |
//     +---------+                  +--+
#pragma once

#include "collide/pairs.hpp"
#include "collide/problem/scratch.hpp"
#include "collide/problem/slim_capsule.hpp"

#include <array>
#include <span>

namespace tess::collide::search {

/// A set of objects that have capsules.
template <class Real>
using ThinSet = detail::ObjectSet<Box<Real, 3>>;

/// The number of pieces of an object.
inline constexpr int most_pieces = 64;
[[nodiscard]] int n_pieces(const Capsule& capsule, double longest) noexcept;
/// The boxes of the pieces of an object.
template <class Real>
using BoxesOfPieces = std::array<Box<Real, 3>, most_pieces>;

/// Objects of a search, in pieces or whole.
template <class Real>
class ThinObjects {
 public:
  static constexpr double whole = std::numeric_limits<double>::infinity();

  /// A piece is at most `longest` long on each axis, if the object needs no more than 64 for that.
  /// The numbers of the objects begin at `first_number`.
  ThinObjects(const ThinSet<Real>& objects, const Frame& frame, double longest,
              std::uint64_t first_number);

  [[nodiscard]] bool in_pieces() const noexcept { return begins_.size() != 0; }
  /// Of the pieces; of the objects if they are whole.
  [[nodiscard]] std::span<const Box<Real, 3>> boxes() const noexcept {
    return in_pieces() ? std::span<const Box<Real, 3>>(pieces_.data(), pieces_.size()) : objects_;
  }

  // What PiecePairs needs (piece_pairs.hpp).
  using Boxes = BoxesOfPieces<Real>;
  [[nodiscard]] const SlimCapsule* capsules() const noexcept { return capsules_.data(); }
  [[nodiscard]] std::uint32_t object_of(std::uint32_t piece) const noexcept {
    return in_pieces() ? objects_of_.data()[piece] : piece;
  }
  [[nodiscard]] std::uint64_t number_of_object(std::uint32_t piece) const noexcept {
    return first_number_ + object_of(piece);
  }
  [[nodiscard]] std::uint32_t number_of(std::uint32_t piece) const noexcept {
    return piece - begins_.data()[object_of(piece)];
  }
  [[nodiscard]] const Box<Real, 3>& box_of_object(std::uint32_t object) const noexcept {
    return objects_[object];
  }
  /// They stand here; no memory is needed.
  [[nodiscard]] std::span<const Box<Real, 3>> pieces_of(std::uint32_t object,
                                                        Boxes& /*memory*/) const noexcept {
    const std::uint32_t begin = begins_.data()[object];
    return {pieces_.data() + begin, begins_.data()[object + 1] - begin};
  }

  [[nodiscard]] std::size_t bytes() const noexcept {
    return pieces_.bytes() + objects_of_.bytes() + begins_.bytes() + capsules_.bytes();
  }

 private:
  std::span<const Box<Real, 3>> objects_;
  std::uint64_t first_number_;
  Scratch<Box<Real, 3>> pieces_;
  Scratch<std::uint32_t> objects_of_, begins_;  // per piece; per object
  Scratch<SlimCapsule> capsules_;
};

/// Its longest extent on an axis, without the radius.
[[nodiscard]] double longest_extent(const Capsule& capsule) noexcept;

/// Writes the boxes of `n` pieces to `out`, and returns their end. A piece of the object is the
/// part that is nearest to a piece of the capsule's segment, so the boxes contain the object
/// together. Pieces of the capsule beside the object's box have none.
template <class Real>
Box<Real, 3>* cut(const Box<Real, 3>& box, const Capsule& capsule, int n,
                  Box<Real, 3>* out) noexcept;

}  // namespace tess::collide::search
