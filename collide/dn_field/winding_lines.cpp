#include "collide/dn_field/winding_lines.hpp"

#include <algorithm>

namespace tess::dn {
namespace {

/// On which side of the line a -> b, seen along x, the point (y, z) lies: +1 or -1, never 0. Always
/// evaluated from the lower vertex number, so that two triangles at one edge agree; ties are
/// decided as if the point were moved by (e, e²), e -> 0, so that triangles around one vertex agree
/// too.
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
  const double first = std::ceil((low - origin) / cell), last = std::floor((high - origin) / cell);
  return {static_cast<int>(std::clamp(first, 0.0, 1.0 * n)),
          static_cast<int>(std::clamp(last, -1.0, n - 1.0))};
}

}  // namespace

std::vector<std::uint8_t> inside_by_lines(const Surface& surface,
                                          const Bvh& tree,
                                          const Grid& grid) {
  const int nx = grid.n[0];
  const auto stride =
      static_cast<std::size_t>(nx) + 1;  // the last entry: crossings behind the line's last voxel
  const auto line = [&](int j, int k) {
    return stride * (static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.n[1]) +
                     static_cast<std::size_t>(j));
  };
  std::vector<std::int16_t> change(line(0, grid.n[2]), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [ia, ib, ic] = surface.triangles[t];
    const auto [a, b, c] = surface.corners(t);
    const Vec3 normal = cross(b - a, c - a);
    if (normal.x == 0) continue;
    const auto [ylow, yhigh] = std::minmax({a.y, b.y, c.y});
    const auto [zlow, zhigh] = std::minmax({a.z, b.z, c.z});
    const Range js = voxels_between(ylow, yhigh, grid.origin.y, grid.cell, grid.n[1]);
    const Range ks = voxels_between(zlow, zhigh, grid.origin.z, grid.cell, grid.n[2]);
    for (int k = ks.first; k <= ks.last; ++k)
      for (int j = js.first; j <= js.last; ++j) {
        const Vec3 p = grid.centre(0, j, k);
        const int s = side(surface, ia, ib, p.y, p.z);
        if (side(surface, ib, ic, p.y, p.z) != s || side(surface, ic, ia, p.y, p.z) != s) continue;
        const double x = a.x - (normal.y * (p.y - a.y) + normal.z * (p.z - a.z)) / normal.x;
        const double voxel = std::clamp(std::ceil((x - grid.origin.x) / grid.cell), 0.0, 1.0 * nx);
        change[line(j, k) + static_cast<std::size_t>(voxel)] -= static_cast<std::int16_t>(s);
      }
  }
  std::vector<std::uint8_t> inside(grid.size());
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j) {
      const std::int16_t* crossings = &change[line(j, k)];
      int winding = 0;
      for (int i = 0; i < nx; ++i) {
        winding += crossings[i];
        inside[grid.index(i, j, k)] = winding > 0 ? 1 : 0;
      }
      if (winding + crossings[nx] == 0) continue;
      for (int i = 0; i < nx; ++i)
        inside[grid.index(i, j, k)] = tree.is_inside(grid.centre(i, j, k)) ? 1 : 0;
    }
  return inside;
}

}  // namespace tess::dn
