#include "apps/amr/block_index.hpp"

namespace amr {

std::array<std::int32_t, 3> BlockIndex::coordinates() const {
  std::array<std::int32_t, 3> place{};
  for (std::int32_t up = 0; up < level(); ++up)
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      place[axis] |=
          static_cast<std::int32_t>(path >> (3 * static_cast<std::uint32_t>(up) + axis) & 1U) << up;
  return place;
}

BlockIndex BlockIndex::at(std::int32_t level, const std::array<std::int32_t, 3>& place) {
  BlockIndex index;
  for (std::int32_t down = level - 1; down >= 0; --down)
    index = index.child((place[0] >> down & 1) | (place[1] >> down & 1) << 1 |
                        (place[2] >> down & 1) << 2);
  return index;
}

double BlockIndex::along() const {
  const std::uint64_t n = std::uint64_t{1} << 3U * static_cast<std::uint32_t>(level());
  return static_cast<double>(path - n) / static_cast<double>(n);
}

BlockIndex BlockIndex::neighbour(Face face) const {
  std::array<std::int32_t, 3> place = coordinates();
  std::int32_t& along = place[static_cast<std::size_t>(face / 2)];
  along = (along + ((face & 1) != 0 ? 1 : -1)) & ((1 << level()) - 1);
  return at(level(), place);
}

}  // namespace amr
