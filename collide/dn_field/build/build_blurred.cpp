#include "collide/dn_field/build_blurred.hpp"

#include "collide/dn_field/build/blur.hpp"
#include "collide/dn_field/build/checks.hpp"
#include "collide/dn_field/build/voxels.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "collide/dn_field/orientation.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace tess::dn {
namespace {
constexpr double exact_share = 0.5;     // of the progress
constexpr int layers_at_once = 16;      // between two calls for progress
constexpr double inward_step = 1.25;    // cells behind a voxel of the surface: inside, or thin
constexpr double thin_share = 0.1;      // of the surface's voxels
constexpr double flipped_share = 0.1;   // of the edges: above, flipped triangles are the cause
constexpr float least_vector = 1e-12F;  // shorter has no direction
constexpr int smoothing_radius = 2;     // of the potential, before its gradient is taken

std::uint32_t code_of(float x, float y, float z) {
  if (std::fabs(x) + std::fabs(y) + std::fabs(z) < least_vector) return no_normal;
  return encode_normal(
      direction({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
}

void require_met(const Surface& surface, const Grid& grid,
                 const std::vector<SurfaceVoxel>& voxels) {
  if (!voxels.empty()) return;
  const auto corner = [](Vec3 p) { return text("(", p.x, ", ", p.y, ", ", p.z, ")"); };
  const Bounds box = bounds(surface);
  fail(ErrorCode::bad_argument,
       "no voxel of the grid meets the surface, which the blurred methods start from: voxels from ",
       corner(grid.origin), " to ",
       corner(grid.centre(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1)), ", surface from ",
       corner(box.low), " to ", corner(box.high),
       "; put the grid around the surface, or take the exact method");
}

bool has_body(const Field& field, std::size_t at, Vec3 normal) {
  const auto& n = field.grid.n;
  const std::array<int, 3> voxel = field.grid.voxel(at);
  const Vec3 inward = -inward_step * direction(normal);
  std::array<int, 3> behind{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double to = voxel[a] + component(inward, static_cast<int>(a));
    behind[a] = static_cast<int>(std::clamp(std::round(to), 0.0, n[a] - 1.0));
  }
  return field.distance[field.grid.index(behind[0], behind[1], behind[2])] < 0;
}

/// Refuses bad input. Returns the surface that is blurred.
Surface checked(const Surface& surface, const Grid& grid, const BlurredOptions& options) {
  if (options.method == Method::exact)
    fail(ErrorCode::bad_argument, "a blurred field by the exact method; take build_exact");
  if (options.method == Method::normals && options.sides == Sides::two)
    fail(ErrorCode::bad_argument,
         "a two-sided field by the normals method, which serves one side alone; take the potential "
         "or the exact method");
  validate(surface);
  require_thick(grid, options.thickness);
  if (options.blur.rounds != 0) require_blur(options.blur);
  require_buildable(grid, bytes_per_voxel_blurring);
  return options.sides == Sides::one ? Surface(OutwardSurface(surface).surface()) : surface;
}

Blur blur_of(const Grid& grid, const BlurredOptions& options) {
  return options.blur.rounds == 0 ? choose_blur(grid, options.thickness) : options.blur;
}

}  // namespace

BlurredBuilder::BlurredBuilder(const Surface& surface, const Grid& grid,
                               const BlurredOptions& options)
    : BlurredBuilder(checked(surface, grid, options), options, grid) {
  field_.surface = fingerprint(surface);  // as given, before orientation repair
}

BlurredBuilder::~BlurredBuilder() = default;

BlurredBuilder::BlurredBuilder(Surface surface, const BlurredOptions& options, const Grid& grid)
    : surface_(std::move(surface)),
      blur_(blur_of(grid, options)),
      // The potential is blurred once more without restoring: the voxels' steps are no slope.
      n_blurs_(options.method == Method::potential ? blur_.rounds + 1 : blur_.rounds),
      exact_(surface_, grid, {options.sides, Content::distance_and_normal, options.thickness, {}}),
      field_(exact_.empty_field()),
      slabs_(static_cast<std::size_t>(grid.n[2])),
      voxels_(surface_voxels(surface_, grid)) {
  require_met(surface_, grid, voxels_);
  field_.method = options.method;
  const std::size_t n_parts = options.method == Method::normals ? 3 : 1;
  for (auto& side : values_) side.assign(n_parts, Values(grid.size()));
  for (std::size_t part = 0; part < n_parts; ++part)
    for (const SurfaceVoxel& v : voxels_) values_[0][part][v.at] = seed(v, part);
}

/// The first value of a voxel of the surface, restored after every round.
float BlurredBuilder::seed(const SurfaceVoxel& voxel, std::size_t part) const {
  return field_.method == Method::potential
             ? 1.0F
             : static_cast<float>(component(voxel.normal, static_cast<int>(part)));
}

std::span<const SurfaceVoxel> BlurredBuilder::voxels_in(int first, int last) const {
  const auto from = [this](int layer) {
    return std::ranges::lower_bound(voxels_, field_.grid.index(0, 0, layer), {}, &SurfaceVoxel::at);
  };
  return {from(first), from(last)};
}

void BlurredBuilder::build_distances(int first, int last) {
  if (first < last)
    slabs_[static_cast<std::size_t>(first)] = exact_.build(slab_of(field_, first, last));
}

void BlurredBuilder::build_round(int round, int first, int last) {
  const bool by_normals = field_.method == Method::normals;
  if (round == 0 && first == 0 && by_normals) require_body();
  if (round < n_blurs_) return blur(round, first, last);
  by_normals ? set_normals(first, last) : set_gradients(first, last);
}

void BlurredBuilder::require_body() const {
  std::size_t thin = 0;
  for (const SurfaceVoxel& v : voxels_)
    if (!has_body(field_, v.at, v.normal)) ++thin;
  if (static_cast<double>(thin) <= thin_share * static_cast<double>(voxels_.size())) return;
  const double disagreeing = disagreeing_share(welded(surface_));
  if (disagreeing > flipped_share)
    fail(ErrorCode::bad_argument, "the orientation of triangles disagrees at ", 100 * disagreeing,
         " % of the edges between two, and ", thin, " of ", voxels_.size(),
         " voxels of the surface have no inside behind them; the normals method needs triangles "
         "that agree which side is out: orient them, or take a two-sided field by the potential or "
         "the exact method");
  fail(ErrorCode::bad_argument, "the object is of near-zero thickness in ", thin, " of ",
       voxels_.size(), " voxels of its surface, with cells of ", field_.grid.cell,
       "; the normals method fails there: take the potential or the exact method, or a higher "
       "resolution");
}

void BlurredBuilder::blur(int round, int first, int last) {
  const auto& before = values_[static_cast<std::size_t>(round % 2)];
  auto& after = values_[static_cast<std::size_t>((round + 1) % 2)];
  const bool restores = round < blur_.rounds;
  for (std::size_t part = 0; part < before.size(); ++part) {
    blur_layers(field_.grid, restores ? blur_.radius : smoothing_radius, before[part], after[part],
                first, last);
    if (!restores) continue;
    for (const SurfaceVoxel& v : voxels_in(first, last)) after[part][v.at] = seed(v, part);
  }
}

void BlurredBuilder::set_normals(int first, int last) {
  const auto& parts = values_[static_cast<std::size_t>(n_blurs_ % 2)];
  const Grid& grid = field_.grid;
  for (std::size_t at = grid.index(0, 0, first); at < grid.index(0, 0, last); ++at)
    if (field_.normal[at] != no_normal)
      field_.normal[at] = code_of(parts[0][at], parts[1][at], parts[2][at]);
}

/// Voxels of the surface, the ridge of the potential without gradient, keep their exact normals.
void BlurredBuilder::set_gradients(int first, int last) {
  const Values& potential = values_[static_cast<std::size_t>(n_blurs_ % 2)].front();
  const Grid& grid = field_.grid;
  const auto slope = [&](std::size_t at, int voxel, int n, std::size_t stride) {
    const std::size_t up = voxel + 1 < n ? at + stride : at, down = voxel > 0 ? at - stride : at;
    const float width = up - down == 2 * stride ? 0.5F : 1.0F;
    return width * (potential[down] - potential[up]);  // away from the object
  };
  auto ridge = voxels_in(first, last);
  for (int k = first; k < last; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const std::size_t at = grid.index(i, j, k);
        if (!ridge.empty() && ridge.front().at == at) {
          ridge = ridge.subspan(1);
          continue;
        }
        if (field_.normal[at] == no_normal) continue;
        const float sign = field_.distance[at] < 0 ? -1.0F : 1.0F;
        field_.normal[at] = code_of(sign * slope(at, i, grid.n[0], 1),
                                    sign * slope(at, j, grid.n[1], grid.index(0, 1, 0)),
                                    sign * slope(at, k, grid.n[2], grid.index(0, 0, 1)));
      }
}

Field BlurredBuilder::finish() {
  exact_.finish(field_, slabs_);
  return std::move(field_);
}

Field build_blurred(const Surface& surface, const Grid& grid, const BlurredOptions& options) {
  BlurredBuilder builder(surface, grid, options);
  const auto report = [&](double done) {
    if (options.progress) options.progress(done);
  };
  const int n = grid.n[2];
  for (int k = 0; k < n; k += layers_at_once) {
    const int next = std::min(k + layers_at_once, n);
    builder.build_distances(k, next);
    report(exact_share * next / n);
  }
  for (int round = 0; round < builder.n_rounds(); ++round) {
    builder.build_round(round, 0, n);
    report(exact_share + (1 - exact_share) * (round + 1) / builder.n_rounds());
  }
  return builder.finish();
}

}  // namespace tess::dn
