#include "collide/dn_field/field.hpp"

#include "collide/dn_field/compressed.hpp"

#include <algorithm>

namespace tess::dn {

// Adjacent voxels are corners of one cube of 2³ voxels, so the least and the greatest value of each
// cube suffice: first of its four edges along x, then of the two ends. Along an axis of one voxel
// the cubes are flat. Cubes with a NaN are left out.
float greatest_jump(const Field& field) {
  const Grid& grid = field.grid;
  const auto next = [](int n) { return n > 1 ? 1 : 0; };
  const auto nx = static_cast<std::size_t>(grid.n[0]);
  const auto right = static_cast<std::size_t>(next(grid.n[0]));
  const int up = next(grid.n[1]), above = next(grid.n[2]);
  std::vector<float> low(nx), high(nx);
  float largest = 0;
  for (int k = 0; k < grid.n[2] - above; ++k)
    for (int j = 0; j < grid.n[1] - up; ++j) {
      const auto row = [&](int dj, int dk) {
        return &field.distance[grid.index(0, j + dj, k + dk)];
      };
      const float *a = row(0, 0), *b = row(up, 0), *c = row(0, above), *d = row(up, above);
      for (std::size_t i = 0; i < nx; ++i) {
        low[i] = std::min(std::min(a[i], b[i]), std::min(c[i], d[i]));
        high[i] = std::max(std::max(a[i], b[i]), std::max(c[i], d[i]));
      }
      for (std::size_t i = 0; i + right < nx; ++i)
        largest = std::max(largest,
                           std::max(high[i], high[i + right]) - std::min(low[i], low[i + right]));
    }
  return largest;
}

std::size_t Field::bytes() const {
  return planes != nullptr
             ? planes->bytes()
             : distance.size() * sizeof(float) + normal.size() * sizeof(std::uint32_t);
}

Content Field::content() const {
  return planes == nullptr && normal.empty() ? Content::distance : Content::distance_and_normal;
}

}  // namespace tess::dn
