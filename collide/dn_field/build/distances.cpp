#include "collide/dn_field/build/distances.hpp"

#include "collide/dn_field/normal_code.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double on_surface = 1e-3;  // of a cell: nearer, the direction to the surface is rounding
constexpr int block_edge = block_layers;
constexpr int query_edge = 4 * block_edge;  // voxels in x and y that are skipped together
// Of squares: up to where cut_off() is stored.
constexpr double just_beyond = (1 + 0x1p-21) * (1 + 0x1p-21) * (1 + 1e-9);

int up_to(int voxel, int step, int n) {
  return std::min(voxel + step, n);
}

}  // namespace

Distances::Distances(const Surface& surface, Sides sides, const Grid& grid) : tree_(surface) {
  if (sides == Sides::one) inside_.emplace(surface, tree_, grid);
}

// The sign stands in the field already.
void Distances::fill_block(Field& field, int i, int j, int k) const {
  const Grid& grid = field.grid;
  PointBlock block;
  const double limit2 = field.thickness * field.thickness * just_beyond;
  const auto far = static_cast<double>(cut_off(field.thickness));
  std::size_t lane = 0;
  for (int dk = 0; dk < block_edge; ++dk)
    for (int dj = 0; dj < block_edge; ++dj)
      for (int di = 0; di < block_edge; ++di, ++lane) {
        const Vec3 p = grid.centre(i + di, j + dj, k + dk);
        block.x[lane] = p.x, block.y[lane] = p.y, block.z[lane] = p.z;
        const bool asks = i + di < grid.n[0] && j + dj < grid.n[1] && k + dk < grid.n[2];
        block.distance2[lane] = asks ? limit2 : -1;
      }
  tree_.closest(block);
  for (int z = k; z < up_to(k, block_edge, grid.n[2]); ++z)
    for (int y = j; y < up_to(j, block_edge, grid.n[1]); ++y)
      for (int x = i; x < up_to(i, block_edge, grid.n[0]); ++x) {
        lane = static_cast<std::size_t>(((z - k) * block_edge + y - j) * block_edge + x - i);
        const auto place = block.place[lane];
        if (place == PointBlock::none) continue;
        const auto at = grid.index(x, y, z);
        const PreparedTriangle& triangle = tree_.triangle(place);
        const Vec3 offset = offset_from(triangle, grid.centre(x, y, z));
        const double distance = std::min(norm(offset), far);
        const double sign = field.distance[at] < 0 ? -1 : 1;
        field.distance[at] = static_cast<float>(sign * distance);
        if (field.normal.empty()) continue;
        field.normal[at] = encode_normal(distance < on_surface * grid.cell
                                             ? normal_at(triangle, grid.centre(x, y, z), grid.cell)
                                             : sign * offset);
      }
}

/// At a point of the surface. A degenerate triangle there has no normal, but those beside it do.
Vec3 Distances::normal_at(const PreparedTriangle& triangle, Vec3 p, double cell) const {
  const double reach = 2 * on_surface * cell;
  return triangle.normal != Vec3{} ? triangle.normal : tree_.nearest_normal(p, reach * reach);
}

void Distances::fill_shelf(Field& field, int first) const {
  const Grid& grid = field.grid;
  const int last = up_to(first, block_edge, grid.n[2]);
  const std::size_t begin = grid.index(0, 0, first), size = grid.index(0, 0, last) - begin;
  std::vector<std::uint8_t> inside(size);
  if (inside_)
    for (int k = first; k < last; ++k)
      inside_->layer(k, std::span(inside).subspan(grid.index(0, 0, k - first)));
  const float far = cut_off(field.thickness);
  for (std::size_t at = 0; at < size; ++at)
    field.distance[begin + at] = inside[at] != 0 ? -far : far;
  if (!field.normal.empty()) std::fill_n(&field.normal[begin], size, no_normal);
  const double limit2 = field.thickness * field.thickness * just_beyond;
  for (int tj = 0; tj < grid.n[1]; tj += query_edge)
    for (int ti = 0; ti < grid.n[0]; ti += query_edge) {
      Bounds tile;
      tile.extend(grid.centre(ti, tj, first));
      tile.extend(grid.centre(ti + query_edge - 1, tj + query_edge - 1, first + block_edge - 1));
      if (!tree_.may_reach(tile, limit2)) continue;
      for (int j = tj; j < up_to(tj, query_edge, grid.n[1]); j += block_edge)
        for (int i = ti; i < up_to(ti, query_edge, grid.n[0]); i += block_edge)
          fill_block(field, i, j, first);
    }
}

void Distances::fill(Field& field, int first, int last) const {
  for (int k = first; k < last; k += block_edge) fill_shelf(field, k);
}

}  // namespace tess::dn
