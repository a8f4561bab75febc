// The pairs of objects among the pairs of their pieces, as serially (search/thin_pairs.hpp): a
// voxel finds pieces whose boxes overlap. Objects whose capsules are apart, or whose boxes do not
// overlap, are no pair. If several pairs of their pieces overlap, in this voxel or in others, the
// first of them counts: the first in the order of the pieces of the object with the lower number.
#pragma once

#include "collide/parallel/object_list.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tess::collide {

class PiecePairs {
 public:
  /// At most so many at a time.
  static constexpr std::size_t most = 512;

  /// Of n pairs of pieces, which are boxes of two lists.
  void find(const ObjectList& of_x, const std::uint32_t* x, const ObjectList& of_y,
            const std::uint32_t* y, std::size_t n, Touching touching);

  /// What counts: one box per object, in the same lists.
  [[nodiscard]] std::size_t size() const noexcept { return n_; }
  [[nodiscard]] const std::uint32_t* x() const noexcept { return x_.data(); }
  [[nodiscard]] const std::uint32_t* y() const noexcept { return y_.data(); }

 private:
  using Numbers = std::array<std::uint32_t, most + 8>;

  std::size_t n_ = 0;
  Numbers x_, y_;
};

}  // namespace tess::collide
