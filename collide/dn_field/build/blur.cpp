#include "collide/dn_field/build/blur.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tess::dn {
namespace {

struct Tap {
  int dx, dy, dz;
  float weight;
};

std::vector<Tap> kernel(int radius) {
  std::vector<Tap> taps;
  double sum = 0;
  for (int dz = -radius; dz <= radius; ++dz)
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx) {
        const double r = std::sqrt(1.0 * dx * dx + 1.0 * dy * dy + 1.0 * dz * dz);
        if (r > radius) continue;
        taps.push_back({dx, dy, dz, static_cast<float>(1 - r / (radius + 1))});
        sum += 1 - r / (radius + 1);
      }
  for (Tap& tap : taps) tap.weight = static_cast<float>(static_cast<double>(tap.weight) / sum);
  return taps;
}

}  // namespace

void blur_layers(const Grid& grid, int radius, std::span<const float> before,
                 std::span<float> after, int first, int last) {
  const auto nx = static_cast<std::ptrdiff_t>(grid.n[0]);
  const int low = std::max(0, first - radius), high = std::min(grid.n[2], last + radius);
  const auto row = [&](int j, int k) { return grid.index(0, j, k); };
  const auto number = [&](int j, int k) {
    return static_cast<std::size_t>(k - low) * static_cast<std::size_t>(grid.n[1]) +
           static_cast<std::size_t>(j);
  };
  std::vector<std::uint8_t> empty(number(0, high));  // most rows are, in the first rounds
  for (int k = low; k < high; ++k)
    for (int j = 0; j < grid.n[1]; ++j) {
      const float* const from = &before[row(j, k)];
      empty[number(j, k)] = std::all_of(from, from + nx, [](float v) { return v == 0; }) ? 1 : 0;
    }
  const auto taps = kernel(radius);
  for (int k = first; k < last; ++k)
    for (int j = 0; j < grid.n[1]; ++j) {
      float* const to = &after[row(j, k)];
      std::fill(to, to + nx, 0.0F);
      for (const auto& [dx, dy, dz, weight] : taps) {
        const int y = j + dy, z = k + dz;
        if (y < 0 || y >= grid.n[1] || z < 0 || z >= grid.n[2] || empty[number(y, z)] != 0)
          continue;
        const float* const from = &before[row(y, z)];
        const std::ptrdiff_t shift = dx;
        const auto begin = std::max<std::ptrdiff_t>(0, -shift), end = std::min(nx, nx - shift);
        for (std::ptrdiff_t i = begin; i < end; ++i) to[i] += weight * from[i + shift];
      }
    }
}

}  // namespace tess::dn
