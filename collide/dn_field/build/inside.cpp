#include "collide/dn_field/build/inside.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

/// The side of the line a -> b, seen along x, on which the point (y, z) lies: +1 or -1, never 0. It
/// is computed from the lower vertex number, so that two triangles at an edge agree. Ties are
/// decided as if the point were moved by (e, e²), e -> 0, so that triangles around a vertex agree.
int side(const Surface& surface, std::uint32_t ia, std::uint32_t ib, double y, double z) {
  const int flip = ia < ib ? 1 : -1;
  const Vec3 a = surface.vertices[std::min(ia, ib)], b = surface.vertices[std::max(ia, ib)];
  const double dy = b.y - a.y, dz = b.z - a.z;
  const double area = dy * (z - a.z) - dz * (y - a.y);
  if (area != 0) return area > 0 ? flip : -flip;
  if (dz != 0) return dz < 0 ? flip : -flip;
  return dy >= 0 ? flip : -flip;
}

struct Range {
  int first, last;  // inclusive; empty where last < first
};

Range voxels_between(double low, double high, double origin, double cell, int n) {
  // side() compares with the centres themselves, from which the quotients differ by rounding.
  const double first = std::ceil((low - origin) / cell) - 1,
               last = std::floor((high - origin) / cell) + 1;
  Range range{static_cast<int>(std::clamp(first, 0.0, 1.0 * n)),
              static_cast<int>(std::clamp(last, -1.0, n - 1.0))};
  while (range.first <= range.last && origin + cell * range.first < low) ++range.first;
  while (range.first <= range.last && origin + cell * range.last > high) --range.last;
  return range;
}

}  // namespace

Inside::Inside(Surface surface, const Bvh& tree, const Grid& grid)
    : surface_(std::move(surface)), tree_(tree), grid_(grid), closed_(is_closed(surface_)) {
  if (!closed_) return;
  const auto layers_of = [&](std::size_t t) {
    const auto [a, b, c] = surface_.corners(t);
    const auto [low, high] = std::minmax({a.z, b.z, c.z});
    return voxels_between(low, high, grid_.origin.z, grid_.cell, grid_.n[2]);
  };
  begin_.assign(static_cast<std::size_t>(grid_.n[2]) + 2, 0);
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
    for (auto [k, last] = layers_of(t); k <= last; ++k) ++begin_[static_cast<std::size_t>(k) + 2];
  for (std::size_t k = 2; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  triangles_.resize(begin_.back());
  for (std::size_t t = 0; t < surface_.triangles.size(); ++t)
    for (auto [k, last] = layers_of(t); k <= last; ++k)
      triangles_[begin_[static_cast<std::size_t>(k) + 1]++] = static_cast<std::uint32_t>(t);
}

/// Adds to `change` what the winding number changes by at each voxel of each line.
void Inside::count_crossings(std::uint32_t triangle, int k, std::span<std::int32_t> change) const {
  const auto [ia, ib, ic] = surface_.triangles[triangle];
  const auto [a, b, c] = surface_.corners(triangle);
  const Vec3 normal = cross(b - a, c - a);
  if (normal.x == 0) return;
  const int nx = grid_.n[0];
  const auto [low, high] = std::minmax({a.y, b.y, c.y});
  const auto [left, right] = std::minmax({a.x, b.x, c.x});
  const Range js = voxels_between(low, high, grid_.origin.y, grid_.cell, grid_.n[1]);
  for (int j = js.first; j <= js.last; ++j) {
    const Vec3 p = grid_.centre(0, j, k);
    const int s = side(surface_, ia, ib, p.y, p.z);
    if (side(surface_, ib, ic, p.y, p.z) != s || side(surface_, ic, ia, p.y, p.z) != s) continue;
    // Within the triangle, also where its plane nearly holds the x axis.
    const double x =
        std::clamp(a.x - (normal.y * (p.y - a.y) + normal.z * (p.z - a.z)) / normal.x, left, right);
    const double voxel = std::clamp(std::ceil((x - grid_.origin.x) / grid_.cell), 0.0, 1.0 * nx);
    change[static_cast<std::size_t>(j) * (static_cast<std::size_t>(nx) + 1) +
           static_cast<std::size_t>(voxel)] -= s;
  }
}

void Inside::layer(int k, std::span<std::uint8_t> inside) const {
  const auto [nx, ny, nz] = grid_.n;
  const auto line_size = static_cast<std::size_t>(nx) + 1;
  // The last entry of a line counts crossings behind its last voxel.
  std::vector<std::int32_t> change(static_cast<std::size_t>(ny) * line_size, 0);
  if (closed_)
    for (auto i = begin_[static_cast<std::size_t>(k)]; i < begin_[static_cast<std::size_t>(k) + 1];
         ++i)
      count_crossings(triangles_[i], k, change);
  for (int j = 0; j < ny; ++j) {
    const auto line = std::span(change).subspan(static_cast<std::size_t>(j) * line_size, line_size);
    int winding = 0;
    for (std::int32_t& at : line) at = winding += at;
    // A count that does not end at zero lost a crossing to rounding.
    const bool is_known = closed_ && winding == 0;
    for (int i = 0; i < nx; ++i)
      inside[grid_.index(i, j, 0)] = (is_known ? line[static_cast<std::size_t>(i)] > 0
                                               : tree_.is_inside(grid_.centre(i, j, k)))
                                         ? 1
                                         : 0;
  }
}

}  // namespace tess::dn
