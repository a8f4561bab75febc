#include "collide/dn_field/build_field.hpp"

#include "collide/dn_field/build/blurred_normals.hpp"
#include "collide/dn_field/build/distances.hpp"
#include "collide/dn_field/walls.hpp"
#include "runtime/base/usable_memory.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <atomic>

namespace tess::dn {
namespace {

bool blurs(const FieldOptions& options) {
  return options.method != Method::exact && options.content == Content::distance_and_normal;
}

void check(const Surface& surface, const Grid& grid, const FieldOptions& options) {
  if (options.method == Method::normals && options.sides == Sides::two)
    fail(ErrorCode::bad_argument,
         "a two-sided field by the normals method, which serves only one side; take the potential "
         "or the exact method");
  validate(surface);
  if (!(options.thickness >= 2 * grid.cell))
    fail(ErrorCode::bad_argument, "thickness ", options.thickness, " of a field with cells of ",
         grid.cell, "; it must be at least two cells");
  if (options.blur.rounds != 0) require_blur(options.blur);
  const auto [nx, ny, nz] = grid.n;
  const std::string grid_text = text("grid of ", nx, " × ", ny, " × ", nz, " voxels");
  if (nx < 1 || ny < 1 || nz < 1)
    fail(ErrorCode::bad_argument, grid_text, "; each axis needs at least one");
  if (!(grid.cell > 0) || !std::isfinite(grid.cell) || !is_finite(grid.origin))
    fail(ErrorCode::bad_argument, "grid with cells of ", grid.cell, " from (", grid.origin.x, ", ",
         grid.origin.y, ", ", grid.origin.z, "); cells must be positive and all of it finite");
  const double wanted = building_bytes_per_voxel(options) * nx * ny * nz,
               there = tess::detail::usable_memory();
  if (wanted > there)
    fail(ErrorCode::environment, grid_text, " takes ", wanted / 1e9,
         " GB to build, this process may have ", there / 1e9, "; lower the resolution");
}

/// The normals method needs an inside behind the surface.
void require_body(const Surface& surface, const Bvh& tree, double cell) {
  constexpr double inward_step = 1.25;  // cells
  const double thin = thin_share(surface, tree, inward_step * cell);
  if (thin > most_thin)
    fail(ErrorCode::bad_argument, 100 * thin,
         " % of the surface has no inside behind it, with cells of ", cell,
         ": the object is of near-zero thickness, or its triangles do not agree which side is out; "
         "the "
         "normals method fails there: take the potential or the exact method, or a higher "
         "resolution");
}

}  // namespace

double building_bytes_per_voxel(const FieldOptions& options) {
  // A blur: three components before and after a round beside the field, and some more.
  return blurs(options) ? 36 : options.content == Content::distance ? 4 : 8;
}

struct FieldBuilder::Parts {
  Distances distances;
  std::optional<BlurredNormals> blurred;
  Field field;
  std::atomic<int> n_layers{0};  // that have distances
};

FieldBuilder::FieldBuilder(const Surface& surface, const Grid& grid, const FieldOptions& options) {
  check(surface, grid, options);
  const Surface body = options.sides == Sides::one ? outward(surface) : surface;
  parts_.reset(new Parts{{body, options.sides, grid}, {}, {}, 0});
  Field& field = parts_->field;
  field = {grid, options.method, options.sides, options.thickness, {}, {}};
  field.surface = fingerprint(surface);
  field.distance.resize(grid.size());
  if (options.content == Content::distance_and_normal) field.normal.resize(grid.size());
  if (!blurs(options)) return;
  if (options.method == Method::normals) require_body(body, parts_->distances.tree(), grid.cell);
  parts_->blurred.emplace(
      body, grid, options.method,
      options.blur.rounds == 0 ? choose_blur(grid, options.thickness) : options.blur);
}

FieldBuilder::~FieldBuilder() = default;

int FieldBuilder::n_rounds() const {
  return 1 + (parts_->blurred ? parts_->blurred->n_rounds() : 0);
}

void FieldBuilder::build(int round, int first, int last) {
  auto& [distances, blurred, field, n_layers] = *parts_;
  TESS_CHECK(
      round >= 0 && round < n_rounds() && first >= 0 && first <= last && last <= field.grid.n[2],
      "layers ", first, " to ", last, " of ", field.grid.n[2], " in round ", round, " of ",
      n_rounds());
  if (round > 0) return blurred->build(round - 1, field, first, last);
  TESS_CHECK(first % block_layers == 0 && (last % block_layers == 0 || last == field.grid.n[2]),
             "layers ", first, " to ", last, " cut a block of ", block_layers);
  distances.fill(field, first, last);
  n_layers += last - first;
}

Field FieldBuilder::finish() {
  Field& field = parts_->field;
  TESS_CHECK(parts_->n_layers == field.grid.n[2], "distances of ", parts_->n_layers.load(),
             " layers, of ", field.grid.n[2]);
  float furthest = 0;
  for (const float d : field.distance) furthest = std::max(furthest, std::fabs(d));
  field.thickness = std::min(field.thickness, static_cast<double>(furthest));
  field.jump = greatest_jump(field);
  return std::move(field);
}

Field build_field(const Surface& surface, const Grid& grid, const FieldOptions& options) {
  FieldBuilder builder(surface, grid, options);
  for (int round = 0; round < builder.n_rounds(); ++round) builder.build(round, 0, grid.n[2]);
  return builder.finish();
}

}  // namespace tess::dn
