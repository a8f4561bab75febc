// How the points of the problem are cut into blocks, and which blocks touch.
#pragma once

#include "apps/stencil/tile.hpp"
#include "runtime/core/index.hpp"

#include <utility>
#include <vector>

namespace stencil {

struct Grid {
  Problem problem;
  std::int32_t n_blocks = 1;  ///< on each axis
  std::int32_t n_steps = 0;
  bool logs_steps = false;

  /// The first point of a block on one axis; sizes differ by at most one.
  [[nodiscard]] std::int32_t first(std::int32_t block) const {
    return static_cast<std::int32_t>(std::int64_t{problem.size} * block / n_blocks);
  }
  [[nodiscard]] Tile tile(tess::Index2 at) const {
    return {problem, first(at.x), first(at.y), first(at.x + 1) - first(at.x),
            first(at.y + 1) - first(at.y)};
  }
  /// The sides that have a neighbour, and the neighbour.
  [[nodiscard]] std::vector<std::pair<Side, tess::Index2>> links(tess::Index2 at) const {
    std::vector<std::pair<Side, tess::Index2>> all;
    if (at.x > 0) all.emplace_back(Side::west, tess::Index2{at.x - 1, at.y});
    if (at.x + 1 < n_blocks) all.emplace_back(Side::east, tess::Index2{at.x + 1, at.y});
    if (at.y > 0) all.emplace_back(Side::south, tess::Index2{at.x, at.y - 1});
    if (at.y + 1 < n_blocks) all.emplace_back(Side::north, tess::Index2{at.x, at.y + 1});
    return all;
  }
};

}  // namespace stencil
