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

#include <optional>
#include <span>

namespace tess::collide::search {

template <class Real>
struct ObjectsWithCapsules {
  std::span<const Box<Real, 3>> boxes;
  const detail::Capsules& capsules;
};

/// Objects of a search, in pieces or whole.
template <class Real>
class ThinObjects {
 public:
  static constexpr double whole = std::numeric_limits<double>::infinity();

  /// A piece is at most `longest` long on each axis, if the object needs no more than 64 for that.
  ThinObjects(const ObjectsWithCapsules<Real>& objects, const Frame& frame, double longest);

  [[nodiscard]] bool in_pieces() const noexcept { return begins_.size() != 0; }
  /// Of the pieces; of the objects if they are whole.
  [[nodiscard]] std::span<const Box<Real, 3>> boxes() const noexcept {
    return in_pieces() ? std::span<const Box<Real, 3>>(pieces_.data(), pieces_.size()) : objects_;
  }
  [[nodiscard]] std::span<const Box<Real, 3>> boxes_of_objects() const noexcept { return objects_; }
  [[nodiscard]] const SlimCapsule* capsules() const noexcept { return capsules_.data(); }
  [[nodiscard]] std::uint32_t owner(std::uint32_t piece) const noexcept {
    return in_pieces() ? owners_.data()[piece] : piece;
  }
  /// The boxes of the pieces of an object: where they begin, and themselves.
  [[nodiscard]] std::uint32_t begin(std::uint32_t object) const noexcept {
    return begins_.data()[object];
  }
  [[nodiscard]] std::span<const Box<Real, 3>> pieces(std::uint32_t object) const noexcept {
    return boxes().subspan(begin(object), begins_.data()[object + 1] - begin(object));
  }
  [[nodiscard]] std::size_t bytes() const noexcept {
    return pieces_.bytes() + owners_.bytes() + begins_.bytes() + capsules_.bytes();
  }

 private:
  std::span<const Box<Real, 3>> objects_;
  Scratch<Box<Real, 3>> pieces_;
  Scratch<std::uint32_t> owners_, begins_;
  Scratch<SlimCapsule> capsules_;
};

/// The number of pieces of an object.
inline constexpr int most_pieces = 64;
[[nodiscard]] int n_pieces(const Capsule& capsule, double longest) noexcept;

/// Its longest extent on an axis, without the radius.
[[nodiscard]] double longest_extent(const Capsule& capsule) noexcept;

/// Writes the boxes of `n` pieces to `out`, and returns their end. A piece of the object is the
/// part that is nearest to a piece of the capsule's segment, so the boxes contain the object
/// together. Pieces of the capsule beside the object's box have none.
template <class Real>
Box<Real, 3>* cut(const Box<Real, 3>& box, const Capsule& capsule, int n,
                  Box<Real, 3>* out) noexcept;

/// Whether piece p of x and piece q of y, whose boxes overlap, are the first ones of the two
/// objects that do, in the order of the pieces of x. The nearest ones are looked at first: if there
/// is an earlier pair, it is mostly one of them. Boxes of pieces touch where the objects may
/// overlap.
template <class Real>
[[nodiscard]] bool are_first(std::span<const Box<Real, 3>> x, std::uint32_t p,
                             std::span<const Box<Real, 3>> y, std::uint32_t q,
                             const Box<Real, 3>& whole_y) noexcept {
  for (std::uint32_t before = p + 1; before-- > 0;) {
    if (before != p && !overlap(x[before], whole_y, Touching::counts)) continue;
    for (auto other = before == p ? q : static_cast<std::uint32_t>(y.size()); other-- > 0;)
      if (overlap(x[before], y[other], Touching::counts)) return false;
  }
  return true;
}

}  // namespace tess::collide::search
