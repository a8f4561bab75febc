#include "collide/dn_field/build/blurred_normals.hpp"

#include "collide/dn_field/normal_code.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr int min_radius = 2, max_radius = 4;
constexpr double wanted_rounds = 3;
constexpr float least_vector = 1e-12F;  // shorter has no direction
constexpr int smoothing_radius = 2;     // of the potential, before its gradient is taken

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

/// One round of a blur with linear attenuation: `before` into the layers `first` to `last` − 1 of
/// `after`; both hold grid.size() values. Values beyond the grid count as zero; the weights sum up
/// to one. How the layers are split changes no value.
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

/// Sets the normal; far from the surface, where the blur has died away, it stays exact.
void set_normal(std::uint32_t& code, float x, float y, float z) {
  if (std::fabs(x) + std::fabs(y) + std::fabs(z) < least_vector) return;
  code = encode_normal(
      direction({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
}

}  // namespace

Blur choose_blur(const Grid& grid, double thickness) {
  // At most the grid: the thickness may be infinite.
  const double cells =
      std::min(thickness / grid.cell, 1.0 * std::max({grid.n[0], grid.n[1], grid.n[2]}));
  const int radius =
      std::clamp(static_cast<int>(std::lround(cells / wanted_rounds)), min_radius, max_radius);
  return {radius, static_cast<int>(std::ceil(cells / radius)) + 1};
}

void require_blur(const Blur& blur) {
  if (blur.radius < min_radius || blur.radius > max_radius)
    fail(ErrorCode::bad_argument, "blur of radius ", blur.radius, " voxels; it must be ",
         min_radius, " to ", max_radius);
  if (blur.rounds < 1)
    fail(ErrorCode::bad_argument, "blur of ", blur.rounds, " rounds; it takes at least one");
}

BlurredNormals::BlurredNormals(const Surface& surface, const Grid& grid, Method method,
                               const Blur& blur)
    : method_(method),
      blur_(blur),
      // The potential is blurred once more without restoring: the voxels' steps are no slope.
      n_blurs_(method == Method::potential ? blur.rounds + 1 : blur.rounds),
      voxels_(surface_voxels(surface, grid)) {
  if (voxels_.empty())
    fail(ErrorCode::bad_argument,
         "no voxel of the grid meets the surface, which the blurred methods start from; put the "
         "grid "
         "around the surface, or take the exact method");
  const std::size_t n_parts = method == Method::normals ? 3 : 1;
  for (auto& side : values_) side.assign(n_parts, Values(grid.size()));
  for (std::size_t part = 0; part < n_parts; ++part)
    for (const SurfaceVoxel& v : voxels_) values_[0][part][v.at] = seed(v, part);
}

/// The first value of a voxel of the surface, restored after every round.
float BlurredNormals::seed(const SurfaceVoxel& voxel, std::size_t part) const {
  return method_ == Method::potential
             ? 1.0F
             : static_cast<float>(component(voxel.normal, static_cast<int>(part)));
}

std::span<const SurfaceVoxel> BlurredNormals::voxels_in(const Grid& grid, int first,
                                                        int last) const {
  const auto from = [&](int layer) {
    return std::ranges::lower_bound(voxels_, grid.index(0, 0, layer), {}, &SurfaceVoxel::at);
  };
  return {from(first), from(last)};
}

void BlurredNormals::build(int round, Field& field, int first, int last) {
  if (round < n_blurs_) return blur(round, field.grid, first, last);
  method_ == Method::normals ? set_normals(field, first, last) : set_gradients(field, first, last);
}

void BlurredNormals::blur(int round, const Grid& grid, int first, int last) {
  const auto& before = values_[static_cast<std::size_t>(round % 2)];
  auto& after = values_[static_cast<std::size_t>((round + 1) % 2)];
  const bool restores = round < blur_.rounds;
  for (std::size_t part = 0; part < before.size(); ++part) {
    blur_layers(grid, restores ? blur_.radius : smoothing_radius, before[part], after[part], first,
                last);
    if (!restores) continue;
    for (const SurfaceVoxel& v : voxels_in(grid, first, last)) after[part][v.at] = seed(v, part);
  }
}

void BlurredNormals::set_normals(Field& field, int first, int last) const {
  const auto& parts = values_[static_cast<std::size_t>(n_blurs_ % 2)];
  const Grid& grid = field.grid;
  for (std::size_t at = grid.index(0, 0, first); at < grid.index(0, 0, last); ++at)
    if (field.normal[at] != no_normal)
      set_normal(field.normal[at], parts[0][at], parts[1][at], parts[2][at]);
}

/// Voxels of the surface, the ridge of the potential without gradient, keep their exact normals.
void BlurredNormals::set_gradients(Field& field, int first, int last) const {
  const Values& potential = values_[static_cast<std::size_t>(n_blurs_ % 2)].front();
  const Grid& grid = field.grid;
  const auto slope = [&](std::size_t at, int voxel, int n, std::size_t stride) {
    const std::size_t up = voxel + 1 < n ? at + stride : at, down = voxel > 0 ? at - stride : at;
    const float width = up - down == 2 * stride ? 0.5F : 1.0F;
    return width * (potential[down] - potential[up]);  // away from the object
  };
  auto ridge = voxels_in(grid, first, last);
  for (int k = first; k < last; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const std::size_t at = grid.index(i, j, k);
        if (!ridge.empty() && ridge.front().at == at) {
          ridge = ridge.subspan(1);
          continue;
        }
        if (field.normal[at] == no_normal) continue;
        const float sign = field.distance[at] < 0 ? -1.0F : 1.0F;
        set_normal(field.normal[at], sign * slope(at, i, grid.n[0], 1),
                   sign * slope(at, j, grid.n[1], grid.index(0, 1, 0)),
                   sign * slope(at, k, grid.n[2], grid.index(0, 0, 1)));
      }
}

}  // namespace tess::dn
