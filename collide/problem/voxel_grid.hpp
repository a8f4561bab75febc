// The regular grid of voxels over all space: it maps a coordinate to a cell, with 32 bits per axis.
// It stores no voxels. All code that needs a cell uses the same formula, floor((x - origin) *
// per_voxel). Each step of it is monotone under rounding:
//
//     x <= y  =>  cell(x) <= cell(y)
//
// The proof in problem/entry.hpp needs only this, so rounding cannot lose a pair. Public libraries
// that lose 15 % of the pairs use a second formula, k * size + origin, which rounds differently.
#pragma once

#include "collide/box.hpp"
#include "collide/problem/conversion.hpp"

#include <compare>
#include <cstdint>
#include <functional>

namespace tess::collide {

/// The position of a voxel in the grid.
struct Cell {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// The cells from lo to hi, inclusive.
struct CellRange {
  Cell lo;
  Cell hi;

  friend bool operator==(const CellRange&, const CellRange&) = default;

  /// A double, because a range can have 2^96 cells.
  [[nodiscard]] double n_cells() const noexcept {
    return (static_cast<double>(hi.x) - lo.x + 1) * (static_cast<double>(hi.y) - lo.y + 1) *
           (static_cast<double>(hi.z) - lo.z + 1);
  }
  [[nodiscard]] bool contains(const Cell& c) const noexcept {
    return lo.x <= c.x && c.x <= hi.x && lo.y <= c.y && c.y <= hi.y && lo.z <= c.z && c.z <= hi.z;
  }
};

class VoxelGrid {
 public:
  /// Voxels with these edges; one of them has its lower corner at `origin`. Throws Error unless the
  /// origin is finite, and the edges and their inverses are positive and finite.
  VoxelGrid(const Point& origin, const Point& size);
  /// Cubes of edge `size`; one has its lower corner at zero.
  explicit VoxelGrid(double size) : VoxelGrid({0, 0, 0}, {size, size, size}) {}

  [[nodiscard]] const Point& origin() const noexcept { return origin_; }
  [[nodiscard]] const Point& size() const noexcept { return size_; }
  /// Voxels per unit of length: the factor of the formula.
  [[nodiscard]] const Point& per_voxel() const noexcept { return per_voxel_; }

  /// The cell of a point. Throws Error with the coordinate if it is NaN or its index exceeds 32
  /// bits.
  [[nodiscard]] Cell cell_of(const Point& point) const {
    return {index(point[0], 0), index(point[1], 1), index(point[2], 2)};
  }
  /// The cells that a closed box touches: a superset of those that its interior touches.
  [[nodiscard]] CellRange cells_of(const Aabb& box) const {
    return {cell_of(box.lo), cell_of(box.hi)};
  }

  /// The same without an exception: returns false if the box is not valid or exceeds 32-bit
  /// indices.
  [[nodiscard]] bool find_cells(const Aabb& box, CellRange& range) const noexcept {
    static_assert(sizeof box == 6 * sizeof(double) && sizeof range == 6 * sizeof(std::int32_t));
    return search::conversion::convert(constants_, box.lo.data(), &range.lo.x);
  }
  /// The input of the conversion.
  [[nodiscard]] const search::conversion::Constants& constants() const noexcept {
    return constants_;
  }

 private:
  [[nodiscard]] std::int32_t index(double x, std::size_t axis) const;

  Point origin_;
  Point size_;
  Point per_voxel_;
  search::conversion::Constants constants_{};
};

}  // namespace tess::collide

template <>
struct std::hash<tess::collide::Cell> {
  std::size_t operator()(const tess::collide::Cell& c) const noexcept {
    const auto bits = [](std::int32_t v) { return std::uint64_t{static_cast<std::uint32_t>(v)}; };
    std::uint64_t h = (bits(c.x) | bits(c.y) << 32) * 0x9E3779B97F4A7C15u;
    h = (h ^ (h >> 32) ^ bits(c.z)) * 0xD6E8FEB86659FD93u;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};
