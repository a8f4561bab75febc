// The boxes of up to 64 tetrahedra, which a point is compared with at once. The box around all is
// divided into slabs along each axis, and each slab knows, one bit per box, which boxes reach into
// it. So three words, joined by "and", name the boxes that may hold a point; these few are compared
// exactly. Rounding to slabs is monotone: it never separates a point from a box that holds it. A
// few points are compared with all boxes instead, since the slabs take longer to make.
#pragma once

#include "m2m/mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tess::m2m {

class BoxBlock {
 public:
  static constexpr std::size_t capacity = 64;

  /// Takes the padded boxes (locate.hpp), extended by `reach`, of at most `capacity` tetrahedra.
  void load(std::span<const Point> points, std::span<const Tet> tets,
            std::span<const std::uint32_t> members, double reach = 0);
  /// After load() and before maybe_holding().
  void make_slabs();
  /// The box around all of them.
  [[nodiscard]] const Aabb& around() const { return around_; }

  /// A bit per box, in the order of the members: set if the box may hold the point.
  [[nodiscard]] std::uint64_t maybe_holding(const Point& p) const {
    return reaching_[0][slab(0, p[0])] & reaching_[1][slab(1, p[1])] & reaching_[2][slab(2, p[2])];
  }
  /// A bit per box, in the order of the members: set if the closed box holds the point.
  [[nodiscard]] std::uint64_t holding(const Point& p) const;
  /// True if the closed box holds the point. Without branches.
  [[nodiscard]] bool holds(std::size_t box, const Point& p) const {
    return !((p[0] < low_[0][box]) | (p[0] > high_[0][box]) | (p[1] < low_[1][box]) |
             (p[1] > high_[1][box]) | (p[2] < low_[2][box]) | (p[2] > high_[2][box]));
  }

 private:
  static constexpr std::size_t n_slabs = 64;
  using Sides = std::array<double, capacity>;

  /// The slab of a coordinate along an axis. It does not decrease with x.
  [[nodiscard]] std::size_t slab(std::size_t axis, double x) const {
    const double at = (x - around_.lo[axis]) * per_length_[axis];
    constexpr double last = n_slabs - 1;
    return static_cast<std::size_t>(
        static_cast<std::int32_t>(at > 0 ? (at < last ? at : last) : 0));
  }
  std::size_t n_ = 0;  // boxes
  Aabb around_{};
  Point per_length_{};
  std::array<Sides, 3> low_{}, high_{};
  std::array<std::array<std::uint64_t, n_slabs + 1>, 3> reaching_{};  // and one after the last
};

}  // namespace tess::m2m
