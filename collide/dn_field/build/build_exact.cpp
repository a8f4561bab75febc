#include "collide/dn_field/build_exact.hpp"

#include "collide/dn_field/build/checks.hpp"
#include "collide/dn_field/build/sign.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double on_surface = 1e-3;  // of a cell: nearer, the direction to the surface is rounding
constexpr int block_edge = 4;
constexpr int query_edge = 4 * block_edge;  // voxels in x and y that are skipped together
constexpr double just_beyond = 1 + 1e-9;

/// Refuses bad input. Returns null for a two-sided field.
std::unique_ptr<const OutwardSurface> outward_of(const Surface& surface, const Grid& grid,
                                                 const ExactOptions& options) {
  validate(surface);
  require_thick(grid, options.thickness);
  require_buildable(grid, options.content == Content::distance ? 4 : 8);
  return options.sides == Sides::two ? nullptr : std::make_unique<const OutwardSurface>(surface);
}

int up_to(int voxel, int step, int n) {
  return std::min(voxel + step, n);
}

}  // namespace

/// Some layers of a slab, within one row of blocks.
struct ExactBuilder::Shelf {
  int first, last;  // layers
  int block_first;  // layer at which the blocks begin
  std::span<float> distance;
  std::span<std::uint32_t> normal;
  std::span<const std::uint8_t> inside;  // empty for two-sided fields
};

Slab slab_of(Field& field, int first, int last) {
  const auto begin = field.grid.index(0, 0, first), size = field.grid.index(0, 0, last) - begin;
  return {first, last, std::span(field.distance).subspan(begin, size),
          field.normal.empty() ? std::span<std::uint32_t>{}
                               : std::span(field.normal).subspan(begin, size)};
}

ExactBuilder::ExactBuilder(const Surface& surface, const Grid& grid, ExactOptions options)
    : ExactBuilder(surface, outward_of(surface, grid, options), grid, options) {}

ExactBuilder::ExactBuilder(const Surface& surface,
                           const std::unique_ptr<const OutwardSurface>& outward, const Grid& grid,
                           ExactOptions options)
    : grid_(grid),
      surface_(fingerprint(surface)),
      options_(std::move(options)),
      tree_(outward ? outward->surface() : surface) {
  if (outward) inside_ = std::make_unique<const Inside>(*outward, tree_, grid);
}

ExactBuilder::~ExactBuilder() = default;

Field ExactBuilder::empty_field() const {
  Field field{grid_, Method::exact, options_.sides, options_.thickness, {}, {}};
  field.surface = surface_;
  field.distance.resize(grid_.size());
  if (options_.content == Content::distance_and_normal) field.normal.resize(grid_.size());
  return field;
}

// All 64 points of a block are asked for, whichever layers the shelf needs: the result does not
// depend on the split.
void ExactBuilder::fill_block(int i, int j, const Shelf& shelf) const {
  PointBlock block;
  const double limit2 = options_.thickness * options_.thickness * just_beyond;
  std::size_t lane = 0;
  for (int dk = 0; dk < block_edge; ++dk)
    for (int dj = 0; dj < block_edge; ++dj)
      for (int di = 0; di < block_edge; ++di, ++lane) {
        const int k = shelf.block_first + dk;
        const Vec3 p = grid_.centre(i + di, j + dj, k);
        block.x[lane] = p.x, block.y[lane] = p.y, block.z[lane] = p.z;
        const bool asks = i + di < grid_.n[0] && j + dj < grid_.n[1] && k < grid_.n[2];
        block.distance2[lane] = asks ? limit2 : -1;
      }
  tree_.closest(block);
  for (int k = shelf.first; k < shelf.last; ++k)
    for (int y = j; y < up_to(j, block_edge, grid_.n[1]); ++y)
      for (int x = i; x < up_to(i, block_edge, grid_.n[0]); ++x) {
        lane = static_cast<std::size_t>(
            ((k - shelf.block_first) * block_edge + y - j) * block_edge + x - i);
        const auto place = block.place[lane];
        if (place == PointBlock::none) continue;
        const auto at = grid_.index(x, y, k - shelf.first);
        const PreparedTriangle& triangle = tree_.triangle(place);
        const Vec3 offset = offset_from(triangle, grid_.centre(x, y, k));
        const double distance = std::min(norm(offset), options_.thickness);
        const double sign = !shelf.inside.empty() && shelf.inside[at] != 0 ? -1 : 1;
        shelf.distance[at] = static_cast<float>(sign * distance);
        if (shelf.normal.empty()) continue;
        const bool touching = distance < on_surface * grid_.cell;
        shelf.normal[at] = encode_normal(touching ? triangle.normal : sign * offset);
      }
}

double ExactBuilder::build_shelf(const Slab& slab, int first, int last) const {
  const auto begin = grid_.index(0, 0, first - slab.first), size = grid_.index(0, 0, last - first);
  std::vector<std::uint8_t> inside(inside_ ? size : 0);
  if (inside_) inside_->layers(first, last, inside);
  const Shelf shelf{first,
                    last,
                    first - first % block_edge,
                    slab.distance.subspan(begin, size),
                    slab.normal.empty() ? slab.normal : slab.normal.subspan(begin, size),
                    inside};
  const auto far = static_cast<float>(options_.thickness);
  if (inside_) {
    for (std::size_t at = 0; at < size; ++at) shelf.distance[at] = inside[at] != 0 ? -far : far;
  } else {
    std::fill(shelf.distance.begin(), shelf.distance.end(), far);
  }
  std::fill(shelf.normal.begin(), shelf.normal.end(), no_normal);
  const double limit2 = options_.thickness * options_.thickness * just_beyond;
  for (int tj = 0; tj < grid_.n[1]; tj += query_edge)
    for (int ti = 0; ti < grid_.n[0]; ti += query_edge) {
      Bounds tile;
      tile.extend(grid_.centre(ti, tj, shelf.block_first));
      tile.extend(grid_.centre(ti + query_edge - 1, tj + query_edge - 1,
                               shelf.block_first + block_edge - 1));
      if (!tree_.may_reach(tile, limit2)) continue;
      for (int j = tj; j < up_to(tj, query_edge, grid_.n[1]); j += block_edge)
        for (int i = ti; i < up_to(ti, query_edge, grid_.n[0]); i += block_edge)
          fill_block(i, j, shelf);
    }
  float furthest = 0;
  for (const float d : shelf.distance) furthest = std::max(furthest, std::fabs(d));
  return static_cast<double>(furthest);
}

BuiltSlab ExactBuilder::build(const Slab& slab) const {
  TESS_CHECK(slab.first >= 0 && slab.last <= grid_.n[2] && slab.first <= slab.last &&
                 slab.distance.size() == grid_.index(0, 0, slab.last - slab.first) &&
                 (slab.normal.empty() || slab.normal.size() == slab.distance.size()),
             "slab of layers ", slab.first, " to ", slab.last, " of ", grid_.n[2],
             " with room for ", slab.distance.size(), " distances");
  BuiltSlab built{slab.first, slab.last, 0, 0};
  for (int k = slab.first; k < slab.last;) {
    const int next = std::min(k - k % block_edge + block_edge, slab.last);
    built.furthest = std::max(built.furthest, build_shelf(slab, k, next));
    // While its layers are in the cache, with the one below.
    const int below = std::max(slab.first, k - 1);
    const auto layers = slab.distance.subspan(grid_.index(0, 0, below - slab.first),
                                              grid_.index(0, 0, next - below));
    built.jump = std::max(built.jump, greatest_jump(grid_, layers));
    k = next;
    if (options_.progress) options_.progress(1.0 * (k - slab.first) / (slab.last - slab.first));
  }
  return built;
}

void ExactBuilder::finish(Field& field, std::span<const BuiltSlab> slabs) const {
  double furthest = 0;
  int n_layers = 0;
  field.jump = 0;
  for (const BuiltSlab& slab : slabs) {
    if (slab.first == slab.last) continue;
    n_layers += slab.last - slab.first;
    furthest = std::max(furthest, slab.furthest);
    field.jump = std::max(field.jump, slab.jump);
    if (slab.first == 0) continue;
    const Slab seam = slab_of(field, slab.first - 1, slab.first + 1);
    field.jump = std::max(field.jump, greatest_jump(grid_, seam.distance));
  }
  TESS_CHECK(n_layers == grid_.n[2], "slabs of ", n_layers, " layers, of ", grid_.n[2]);
  field.thickness = std::min(options_.thickness, furthest);
}

Field build_exact(const Surface& surface, const Grid& grid, const ExactOptions& options) {
  const ExactBuilder builder(surface, grid, options);
  Field field = builder.empty_field();
  const BuiltSlab whole = builder.build(slab_of(field, 0, grid.n[2]));
  builder.finish(field, {&whole, 1});
  return field;
}

}  // namespace tess::dn
