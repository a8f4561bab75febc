// The regular grid of voxels over all space: coordinate -> cell, 32 bits an axis. Only the
// arithmetic stands here; no voxel is stored. Every part that asks for a cell (who receives an
// object, who reports a pair) goes through the one formula floor((x - origin) * per_voxel), each
// step of which is monotone under rounding:
//   x <= y  =>  cell(x) <= cell(y).
// Territory (territory.hpp) needs nothing more, so rounding cannot lose a pair. The public
// libraries' 15 % loss comes from a second formula, k * size + origin, that rounds differently:
// there is none here.
#pragma once

#include "collide/aabb.hpp"
#include "collide/serial/conversion.hpp"

#include <compare>
#include <cstdint>
#include <functional>

namespace tess::collide {

/// Where a voxel stands in the grid.
struct Cell {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// The cells lo … hi, both included.
struct CellRange {
  Cell lo;
  Cell hi;

  friend bool operator==(const CellRange&, const CellRange&) = default;

  /// How many cells; a double, because 2^96 cells fit in a range and not in an integer.
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
  /// Voxels of `size` per axis, one of which has its lower corner at `origin`.
  /// Error: a size that is not positive and finite (nor its inverse), an origin that is not finite.
  VoxelGrid(const Point& origin, const Point& size);
  /// Cubes of edge `size` with a corner at zero.
  explicit VoxelGrid(double size) : VoxelGrid({0, 0, 0}, {size, size, size}) {}

  [[nodiscard]] const Point& origin() const noexcept { return origin_; }
  [[nodiscard]] const Point& size() const noexcept { return size_; }
  /// Voxels a unit of length: what coordinates are multiplied by.
  [[nodiscard]] const Point& per_voxel() const noexcept { return per_voxel_; }

  /// The cell of a point. Error: NaN, or an index beyond 32 bits, with the coordinate.
  [[nodiscard]] Cell cell_of(const Point& point) const {
    return {index(point[0], 0), index(point[1], 1), index(point[2], 2)};
  }
  /// The cells a closed box touches; a superset of those its interior touches.
  [[nodiscard]] CellRange cells_of(const Aabb& box) const {
    return {cell_of(box.lo), cell_of(box.hi)};
  }

  /// The same without an error: false for a box that is not valid or has no cells.
  [[nodiscard]] bool find_cells(const Aabb& box, CellRange& range) const noexcept {
    static_assert(sizeof box == 6 * sizeof(double) && sizeof range == 6 * sizeof(std::int32_t));
    return serial::conversion::convert(constants_, box.lo.data(), &range.lo.x);
  }
  /// What the conversion reads.
  [[nodiscard]] const serial::conversion::Constants& constants() const noexcept {
    return constants_;
  }

 private:
  [[nodiscard]] std::int32_t index(double x, std::size_t axis) const;

  Point origin_;
  Point size_;
  Point per_voxel_;
  serial::conversion::Constants constants_{};
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
