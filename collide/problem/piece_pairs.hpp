// The pairs of objects among the pairs of their pieces. Objects whose capsules are apart, or whose
// boxes do not overlap, are no pair. Two objects have a common point only if two of their pieces
// have, so their boxes overlap. If several pairs of their pieces overlap, the first of them counts:
// the first in the order of the pieces of the object with the lower number.
//
//     pairs of pieces  ->  capsules may meet?  ->  first of the two objects?  ->  pairs of objects
//
// Serially a set knows all its pieces (ThinObjects). A voxel on chares has some of them, and makes
// those of an object again (PieceTable). Both have, per piece:
//
//     object_of(piece)           the position of its object
//     number_of_object(piece)    the number of its object; no other has it
//     number_of(piece)           its own one among the pieces of its object
//
// and capsules(), box_of_object(object), pieces_of(object, memory for them), and in_pieces(), which is
// false if each object is its only piece.
#pragma once

#include "collide/problem/slim_capsule.hpp"
#include "collide/problem/thin_objects.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tess::collide::search {

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

template <class Pieces>
class PiecePairs {
 public:
  /// At most so many at a time.
  static constexpr std::size_t most = 512;

  /// Finds those that count among n pairs of pieces of two sets, or of one.
  void find(const Pieces& of_x, const std::uint32_t* x, const Pieces& of_y, const std::uint32_t* y,
            std::size_t n, Touching touching) {
    const bool in_pieces = of_x.in_pieces();
    Numbers objects_x, objects_y, kept;
    if (in_pieces) {
      // Without those of an object with itself. They are many, and never the first.
      std::size_t n_others = 0;
      for (std::size_t m = 0; m < n; ++m) {
        x_[n_others] = x[m];
        y_[n_others] = y[m];
        objects_x[n_others] = of_x.object_of(x[m]);
        objects_y[n_others] = of_y.object_of(y[m]);
        n_others += of_x.number_of_object(x[m]) != of_y.number_of_object(y[m]) ? 1U : 0U;
      }
      n_own_ += n - n_others;
      n = n_others;
      x = x_.data();
      y = y_.data();
    }
    const std::size_t n_kept =
        may_meet(of_x.capsules(), of_y.capsules(), in_pieces ? objects_x.data() : x,
                 in_pieces ? objects_y.data() : y, n, kept.data());
    n_ = 0;
    for (std::size_t k = 0; k < n_kept; ++k) {
      const std::uint32_t piece_x = x[kept[k]], piece_y = y[kept[k]];
      if (in_pieces && !counts(of_x, piece_x, of_y, piece_y, touching)) continue;
      x_[n_] = piece_x;
      y_[n_++] = piece_y;
    }
  }

  /// What counts: one piece per object, in the same sets.
  [[nodiscard]] std::size_t size() const noexcept { return n_; }
  [[nodiscard]] const std::uint32_t* x() const noexcept { return x_.data(); }
  [[nodiscard]] const std::uint32_t* y() const noexcept { return y_.data(); }
  /// How many pairs were of an object with itself, of all that were looked at.
  [[nodiscard]] std::uint64_t n_own() const noexcept { return n_own_; }

 private:
  using Numbers = std::array<std::uint32_t, most + 8>;

  [[nodiscard]] static bool counts(const Pieces& of_x, std::uint32_t x, const Pieces& of_y,
                                   std::uint32_t y, Touching touching) noexcept {
    if (!overlap(of_x.box_of_object(of_x.object_of(x)), of_y.box_of_object(of_y.object_of(y)),
                 touching))
      return false;
    return of_x.number_of_object(x) < of_y.number_of_object(y) ? is_first(of_x, x, of_y, y)
                                                               : is_first(of_y, y, of_x, x);
  }
  [[nodiscard]] static bool is_first(const Pieces& of_a, std::uint32_t a, const Pieces& of_b,
                                     std::uint32_t b) noexcept {
    typename Pieces::Boxes memory_a, memory_b;
    const std::uint32_t object_a = of_a.object_of(a), object_b = of_b.object_of(b);
    return are_first(of_a.pieces_of(object_a, memory_a), of_a.number_of(a),
                     of_b.pieces_of(object_b, memory_b), of_b.number_of(b),
                     of_b.box_of_object(object_b));
  }

  std::size_t n_ = 0;
  std::uint64_t n_own_ = 0;
  Numbers x_, y_;
};

}  // namespace tess::collide::search
