#include "collide/dn_field/field.hpp"

#include "collide/dn_field/lanes.hpp"

#include <algorithm>
#include <array>

namespace tess::dn {
namespace {

/// max |a[i] − b[i]|, 0 <= i < count.
float greatest_difference(const float* a, const float* b, int count) {
  using namespace lanes;
  F largest{};
  int i = 0;
  for (; i + width <= count; i += width)
    largest = max(abs(load<F>(a + i) - load<F>(b + i)), largest);
  float result = 0;
  for (int lane = 0; lane < width; ++lane) result = std::max(result, largest[lane]);
  for (; i < count; ++i) result = std::max(result, std::fabs(a[i] - b[i]));
  return result;
}

}  // namespace

float greatest_jump(const Field& field) {
  const Grid& g = field.grid;
  // Of the 26 around a voxel, the 13 that come after it.
  constexpr std::array<std::array<int, 2>, 4> rows{{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
  float largest = 0;
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j) {
      const float* row = &field.distance[g.index(0, j, k)];
      largest = std::max(largest, greatest_difference(row, row + 1, g.n[0] - 1));
      for (const auto [dj, dk] : rows) {
        if (j + dj < 0 || j + dj >= g.n[1] || k + dk >= g.n[2]) continue;
        const float* other = &field.distance[g.index(0, j + dj, k + dk)];
        largest = std::max({largest,
                            greatest_difference(row, other, g.n[0]),
                            greatest_difference(row, other + 1, g.n[0] - 1),
                            greatest_difference(row + 1, other, g.n[0] - 1)});
      }
    }
  return largest;
}

}  // namespace tess::dn
