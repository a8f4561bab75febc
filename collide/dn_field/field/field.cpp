#include "collide/dn_field/field.hpp"

#include "collide/dn_field/compressed.hpp"
#include "collide/dn_field/geometry/lanes.hpp"

#include <algorithm>
#include <array>

namespace tess::dn {
namespace {

/// The greatest difference within any of `count` cubes: of columns i and i + right of four rows.
/// NaN is left out.
float greatest_difference(const std::array<const float*, 4>& rows, int right, int count) {
  using namespace lanes;
  F largest{};
  int i = 0;
  for (; i + width <= count; i += width) {
    F low = all(HUGE_VALF), high = -low;
    for (const float* row : rows)
      for (const int at : {i, i + right}) {
        const F here = load<F>(row + at);
        low = min(here, low), high = max(here, high);
      }
    largest = max(high - low, largest);
  }
  float result = 0;
  for (int lane = 0; lane < width; ++lane) result = std::max(result, largest[lane]);
  for (; i < count; ++i) {
    float low = HUGE_VALF, high = -low;
    for (const float* row : rows)
      for (const int at : {i, i + right})
        low = std::min(low, row[at]), high = std::max(high, row[at]);
    result = std::max(result, high - low);
  }
  return result;
}

}  // namespace

// Adjacent voxels are corners of one cube of 2³ voxels, so the least and the greatest value of each
// cube suffice, in a third of the time of 13 pairs per voxel. Along an axis of one voxel the cubes
// are flat.
float greatest_jump(const Field& field) {
  const Grid& grid = field.grid;
  const auto next = [](int n) { return n > 1 ? 1 : 0; };
  const int right = next(grid.n[0]), up = next(grid.n[1]), above = next(grid.n[2]);
  float largest = 0;
  for (int k = 0; k < grid.n[2] - above; ++k)
    for (int j = 0; j < grid.n[1] - up; ++j) {
      const auto row = [&](int dj, int dk) {
        return &field.distance[grid.index(0, j + dj, k + dk)];
      };
      const std::array rows{row(0, 0), row(up, 0), row(0, above), row(up, above)};
      largest = std::max(largest, greatest_difference(rows, right, grid.n[0] - right));
    }
  return largest;
}

std::size_t Field::bytes() const {
  return planes != nullptr
             ? planes->bytes()
             : distance.size() * sizeof(float) + normal.size() * sizeof(std::uint32_t);
}

Content Field::content() const {
  if (planes != nullptr) return planes->content;
  return normal.empty() ? Content::distance : Content::distance_and_normal;
}

}  // namespace tess::dn
