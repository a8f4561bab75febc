// The cut of space into cubes, one per block. The cubes cover an arena; those on its border reach
// to infinity, so that particles that fly away do not create blocks without end.
#pragma once

#include "collide/dn_field/vec3.hpp"
#include "runtime/core/index.hpp"

#include <algorithm>
#include <cmath>

namespace particles {

struct Space {
  double edge = 1;
  tess::Index3 first, last;  ///< the blocks of the arena, both included

  /// `arena` is covered with one block more on each side.
  [[nodiscard]] static Space around(const tess::dn::Bounds& arena, double edge) {
    const Space unbounded{edge, {-most, -most, -most}, {most, most, most}};
    const tess::Index3 low = unbounded.block_of(arena.low), high = unbounded.block_of(arena.high);
    return {edge, {low.x - 1, low.y - 1, low.z - 1}, {high.x + 1, high.y + 1, high.z + 1}};
  }

  [[nodiscard]] tess::Index3 block_of(tess::dn::Vec3 p) const {
    return {on_axis(p.x, first.x, last.x), on_axis(p.y, first.y, last.y),
            on_axis(p.z, first.z, last.z)};
  }
  /// The half-open box of a block: its low corner included.
  [[nodiscard]] tess::dn::Bounds box(tess::Index3 block) const {
    return {{low(block.x, first.x), low(block.y, first.y), low(block.z, first.z)},
            {high(block.x, last.x), high(block.y, last.y), high(block.z, last.z)}};
  }

 private:
  static constexpr std::int32_t most = 1 << 30;

  /// NaN belongs to the first block.
  [[nodiscard]] std::int32_t on_axis(double at, std::int32_t from, std::int32_t to) const {
    const double block = std::floor(at / edge);
    return std::isnan(block) ? from
                             : static_cast<std::int32_t>(std::clamp<double>(block, from, to));
  }
  [[nodiscard]] double low(std::int32_t block, std::int32_t from) const {
    return block == from ? -HUGE_VAL : edge * block;
  }
  [[nodiscard]] double high(std::int32_t block, std::int32_t to) const {
    return block == to ? HUGE_VAL : edge * (block + 1);
  }
};

}  // namespace particles
