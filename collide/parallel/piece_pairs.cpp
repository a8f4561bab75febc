#include "collide/parallel/piece_pairs.hpp"

#include "collide/problem/thin_objects.hpp"

#include <span>

namespace tess::collide {
namespace {

using Object = PieceTable::Object;
using Boxes = std::array<Aabb, search::most_pieces>;

/// Whether piece p of a and piece q of b are the first ones that overlap. The pieces are made
/// again.
bool is_first(const Object& a, std::uint32_t p, const Object& b, std::uint32_t q) {
  if (a.n_pieces == 1 && b.n_pieces == 1) return true;
  Boxes of_a, of_b;
  const auto pieces = [](const Object& of, Boxes& boxes) {
    return std::span<const Aabb>(boxes.data(),
                                 search::cut(of.box, of.capsule, of.n_pieces, boxes.data()));
  };
  return search::are_first(pieces(a, of_a), p, pieces(b, of_b), q, b.box);
}

}  // namespace

void PiecePairs::find(const ObjectList& of_x, const std::uint32_t* x, const ObjectList& of_y,
                      const std::uint32_t* y, std::size_t n, Touching touching) {
  const PieceTable &pieces_x = of_x.pieces(), &pieces_y = of_y.pieces();
  Numbers objects_x, objects_y, kept;
  // Without those of an object with itself. They are many, and never the first.
  std::size_t n_others = 0;
  for (std::size_t m = 0; m < n; ++m) {
    x_[n_others] = x[m];
    y_[n_others] = y[m];
    objects_x[n_others] = pieces_x.object_of(x[m]);
    objects_y[n_others] = pieces_y.object_of(y[m]);
    n_others += pieces_x.number_of_object(x[m]) != pieces_y.number_of_object(y[m]) ? 1U : 0U;
  }
  const std::size_t n_kept =
      search::may_meet(pieces_x.capsules(), pieces_y.capsules(), objects_x.data(), objects_y.data(),
                       n_others, kept.data());
  n_ = 0;
  for (std::size_t k = 0; k < n_kept; ++k) {
    const std::uint32_t box_x = x_[kept[k]], box_y = y_[kept[k]];
    const Object &a = pieces_x.object(pieces_x.object_of(box_x)),
                 &b = pieces_y.object(pieces_y.object_of(box_y));
    if (!overlap(a.box, b.box, touching)) continue;
    const std::uint32_t p = pieces_x.number_of(box_x), q = pieces_y.number_of(box_y);
    if (!(a.number < b.number ? is_first(a, p, b, q) : is_first(b, q, a, p))) continue;
    x_[n_] = box_x;
    y_[n_++] = box_y;
  }
}

}  // namespace tess::collide
