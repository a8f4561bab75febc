// A rectangle of grid points with a halo of one: the numerics of the stencil program, without
// messages. Values are row-major with the halo, (height + 2) × (width + 2).
#pragma once

#include "apps/stencil/problem.hpp"

#include <array>
#include <vector>

namespace stencil {

enum class Side : std::uint8_t { west, east, south, north };
[[nodiscard]] constexpr Side opposite(Side side) {
  constexpr std::array<Side, 4> of{Side::east, Side::west, Side::north, Side::south};
  return of[static_cast<std::size_t>(side)];
}

/// How far values are from what they should be, and which bits they are; one of two tiles adds.
struct Outcome {
  double from_iterate = 0;   ///< largest distance from the exact Jacobi iterate
  double from_solution = 0;  ///< largest distance from the solution of the differential equation
  std::uint64_t hash = 0;    ///< of the bits of all values; the same for every cut into tiles
};
struct Combine {
  [[nodiscard]] Outcome operator()(const Outcome& a, const Outcome& b) const;
};

class Tile {
 public:
  Tile() = default;
  /// Zeros; the tile's first interior point is (x, y) of the problem's grid.
  Tile(const Problem& problem, std::int32_t x, std::int32_t y, std::int32_t width,
       std::int32_t height);

  /// The outermost values on a side, in the order of growing coordinate.
  [[nodiscard]] std::vector<double> edge(Side side) const;
  /// The neighbour's values beyond a side. Sides without a neighbour keep the boundary value 0.
  void set_halo(Side side, const std::vector<double>& values);

  /// One Jacobi step over the tile; returns the largest change.
  double jacobi();

  [[nodiscard]] Outcome compare(std::int32_t steps) const;

  /// The points of the tile whose coordinates in the grid are multiples of `stride`.
  struct Sampled {
    std::int32_t x = 0, y = 0;  ///< the first one, in strides
    std::int32_t columns = 0;
    std::vector<double> values;
  };
  [[nodiscard]] Sampled sampled(std::int32_t stride) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(problem_, x_, y_, width_, height_, values_, source_);
  }

 private:
  struct Line {
    std::size_t first, stride, n;
  };
  /// The points along a side: of the tile, or of the halo beyond.
  [[nodiscard]] Line line(Side side, bool halo) const;
  [[nodiscard]] std::size_t at(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(width_ + 2) +
           static_cast<std::size_t>(column + 1);
  }

  Problem problem_;
  std::int32_t x_ = 0, y_ = 0, width_ = 0, height_ = 0;
  std::vector<double> values_, source_, next_;  // source: h² f / 4
};

}  // namespace stencil
