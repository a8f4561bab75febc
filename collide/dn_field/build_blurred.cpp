#include "collide/dn_field/build_blurred.hpp"

#include "collide/dn_field/build_blur.hpp"
#include "collide/dn_field/build_checks.hpp"
#include "collide/dn_field/build_exact.hpp"
#include "collide/dn_field/build_voxels.hpp"
#include "collide/dn_field/normal_code.hpp"
#include "collide/dn_field/outward.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <optional>

namespace tess::dn {
namespace {
constexpr double exact_share = 0.5;     // of the progress
constexpr double inward_step = 1.25;    // cells behind a voxel of the surface: inside, or thin
constexpr double thin_share = 0.1;      // of the surface's voxels
constexpr double flipped_share = 0.1;   // of the edges: more, and flips are why nothing is inside
constexpr float least_vector = 1e-12F;  // shorter has no direction
constexpr double bytes_per_voxel = 36;  // field, three components before and after, hits

using Report = std::function<void(double)>;

/// Restores `first` on the surface after every round.
void blur(const Grid& grid,
          const Blur& how,
          const std::vector<SurfaceVoxel>& voxels,
          std::vector<float>& values,
          const Report& done) {
  std::vector<float> first;
  first.reserve(voxels.size());
  for (const SurfaceVoxel& v : voxels) first.push_back(values[v.at]);
  for (int round = 0; round < how.rounds; ++round) {
    blur_once(grid, how.radius, values);
    for (std::size_t i = 0; i < voxels.size(); ++i) values[voxels[i].at] = first[i];
    done((round + 1.0) / how.rounds);
  }
}

std::uint32_t code_of(float x, float y, float z) {
  if (std::fabs(x) + std::fabs(y) + std::fabs(z) < least_vector) return no_normal;
  return encode_normal(
      direction({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}));
}

void require_met(const Surface& surface,
                 const Grid& grid,
                 const std::vector<SurfaceVoxel>& voxels) {
  if (!voxels.empty()) return;
  const auto corner = [](Vec3 p) { return text("(", p.x, ", ", p.y, ", ", p.z, ")"); };
  const Bounds box = bounds(surface);
  fail(ErrorCode::bad_argument,
       "no voxel of the grid meets the surface, which the blurred methods start from: voxels from ",
       corner(grid.origin),
       " to ",
       corner(grid.centre(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1)),
       ", surface from ",
       corner(box.low),
       " to ",
       corner(box.high),
       "; put the grid around the surface, or take the exact method");
}

bool has_body(const Field& field, std::size_t at, Vec3 normal) {
  const auto& n = field.grid.n;
  const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
  const std::array<std::size_t, 3> voxel{at % nx, at / nx % ny, at / nx / ny};
  const Vec3 inward = -inward_step * direction(normal);
  std::array<int, 3> behind{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double to = static_cast<double>(voxel[a]) + component(inward, static_cast<int>(a));
    behind[a] = static_cast<int>(std::clamp(std::round(to), 0.0, n[a] - 1.0));
  }
  return field.distance[field.grid.index(behind[0], behind[1], behind[2])] < 0;
}

void require_body(const Field& field,
                  const Surface& surface,
                  const std::vector<SurfaceVoxel>& voxels) {
  std::size_t thin = 0;
  for (const SurfaceVoxel& v : voxels)
    if (!has_body(field, v.at, v.normal)) ++thin;
  if (static_cast<double>(thin) <= thin_share * static_cast<double>(voxels.size())) return;
  const double disagreeing = disagreeing_share(welded(surface));
  if (disagreeing > flipped_share)
    fail(ErrorCode::bad_argument,
         "the orientation of triangles disagrees at ",
         100 * disagreeing,
         " % of the edges between two, and ",
         thin,
         " of ",
         voxels.size(),
         " voxels of the surface have no inside behind them; the normals method needs triangles "
         "that agree which side is out: orient them, or take a two-sided field by the potential or "
         "the exact method");
  fail(ErrorCode::bad_argument,
       "the object is of near-zero thickness in ",
       thin,
       " of ",
       voxels.size(),
       " voxels of its surface, with cells of ",
       field.grid.cell,
       "; the normals method fails there: take the potential or the exact method, or a higher "
       "resolution");
}

void blur_normals(Field& field,
                  const Surface& surface,
                  const Blur& how,
                  const std::vector<SurfaceVoxel>& voxels,
                  const Report& done) {
  require_body(field, surface, voxels);
  std::array<std::vector<float>, 3> parts;
  for (int a = 0; a < 3; ++a) {
    auto& part = parts[static_cast<std::size_t>(a)];
    part.assign(field.grid.size(), 0);
    for (const SurfaceVoxel& v : voxels) part[v.at] = static_cast<float>(component(v.normal, a));
    blur(field.grid, how, voxels, part, [&](double share) { done((a + share) / 3); });
  }
  for (std::size_t at = 0; at < field.normal.size(); ++at)
    if (field.normal[at] != no_normal)
      field.normal[at] = code_of(parts[0][at], parts[1][at], parts[2][at]);
}

void blur_potential(Field& field,
                    const Blur& how,
                    const std::vector<SurfaceVoxel>& voxels,
                    const Report& done) {
  const Grid& grid = field.grid;
  std::vector<float> potential(grid.size(), 0);
  for (const SurfaceVoxel& v : voxels) potential[v.at] = 1;
  blur(grid, how, voxels, potential, done);
  blur_once(grid, 2, potential);  // nothing restored: the steps of the voxels are no slope
  std::vector<std::uint8_t> ridge(grid.size(), 0);
  for (const SurfaceVoxel& v : voxels) ridge[v.at] = 1;
  const auto slope = [&](std::size_t at, int voxel, int n, std::size_t stride) {
    const std::size_t up = voxel + 1 < n ? at + stride : at, down = voxel > 0 ? at - stride : at;
    const float width = up - down == 2 * stride ? 0.5F : 1.0F;
    return width * (potential[down] - potential[up]);  // away from the object
  };
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i) {
        const std::size_t at = grid.index(i, j, k);
        if (field.normal[at] == no_normal || ridge[at] != 0) continue;
        const float sign = field.distance[at] < 0 ? -1.0F : 1.0F;
        field.normal[at] = code_of(sign * slope(at, i, grid.n[0], 1),
                                   sign * slope(at, j, grid.n[1], grid.index(0, 1, 0)),
                                   sign * slope(at, k, grid.n[2], grid.index(0, 0, 1)));
      }
}

}  // namespace

Field build_blurred(const Surface& given, const Grid& grid, const BlurredOptions& options) {
  if (options.method == Method::exact)
    fail(ErrorCode::bad_argument, "a blurred field by the exact method; take build_exact");
  if (options.method == Method::normals && options.sides == Sides::two)
    fail(ErrorCode::bad_argument,
         "a two-sided field by the normals method, which serves one side alone; take the potential "
         "or the exact method");
  validate(given);
  require_thick(grid, options.thickness);
  const Blur how = options.blur.rounds == 0 ? choose_blur(grid, options.thickness) : options.blur;
  require_blur(how);
  require_buildable(grid, bytes_per_voxel);
  std::optional<OutwardSurface> outward;  // its triangles' normals are what is blurred
  if (options.sides == Sides::one) outward.emplace(given);
  const Surface& surface = outward ? outward->surface() : given;
  const auto report = [&](double done) {
    if (options.progress) options.progress(done);
  };
  Field field = build_exact(
      surface,
      grid,
      {options.sides, Content::distance_and_normal, options.thickness, [&](double done) {
         report(exact_share * done);
       }});
  field.method = options.method;
  const auto voxels = surface_voxels(surface, grid);
  require_met(surface, grid, voxels);
  const Report rest = [&](double done) { report(exact_share + (1 - exact_share) * done); };
  if (options.method == Method::normals) {
    blur_normals(field, surface, how, voxels, rest);
  } else {
    blur_potential(field, how, voxels, rest);
  }
  return field;
}

}  // namespace tess::dn
