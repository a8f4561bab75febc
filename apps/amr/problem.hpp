// The advected field: u(x, t) = u0(x - v t) in the periodic unit cube, where u0 is a Gaussian of
// height 1. It is a product of functions of one coordinate, so that the mean over a cell is a
// product of differences of error functions, and values are compared with exact means of cells.
#pragma once

#include <array>
#include <cstdint>

namespace amr {

inline constexpr std::int32_t most_steps = 100'000'000;

struct Problem {
  std::int32_t n_cells = 8;  ///< of a block along each axis; even, at least 4
  std::int32_t least_level = 2, most_level = 4;
  std::int32_t order = 2;  ///< of the scheme, 1 to 3
  double cfl = 0.8;        ///< of the cells of most_level, at most 1
  double end = 0.25;       ///< time
  double width = 0.06;     ///< standard deviation of the Gaussian
  double refine = 0.02;    ///< differences of neighbouring cells beyond which a block is refined
  std::array<double, 3> velocity{1, 0.75, 0.5};
  std::array<double, 3> centre{0.35, 0.4, 0.45};  ///< of the Gaussian at time 0
  bool corrected = true;     ///< coarse cells take the flows of finer neighbours
  std::int32_t n_steps = 0;  ///< 0: set by complete()
  double dt = 0;

  [[nodiscard]] std::int64_t cells_per_block() const {
    return std::int64_t{n_cells} * n_cells * n_cells;
  }
  /// The edge of a cell of a level.
  [[nodiscard]] double spacing(std::int32_t level) const { return 1.0 / (n_cells << level); }
  /// Chooses the steps by `cfl` and `end`. Throws tess::Error for what cannot be computed.
  void complete();
  /// The mean of u over the interval [low, low + h] of one axis, as a factor of the mean over a
  /// cell.
  [[nodiscard]] double mean(std::int32_t axis, double low, double h, double time) const;
};

}  // namespace amr
