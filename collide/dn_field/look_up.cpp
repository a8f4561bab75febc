#include "collide/dn_field/look_up.hpp"

#include "collide/dn_field/field/compressed_sample.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

namespace tess::dn {
namespace {

using namespace lanes;

template <LookUp Kind, Ask Asked>
void fill(const auto& sampler, const Grid& grid, const Points& points, const Answers& answers) {
  const auto per_cell = static_cast<float>(1 / grid.cell);
  const auto ox = static_cast<float>(-grid.origin.x / grid.cell),
             oy = static_cast<float>(-grid.origin.y / grid.cell),
             oz = static_cast<float>(-grid.origin.z / grid.cell);
  const std::size_t count = points.x.size();
  // The last points, fewer than a vector, are copied.
  const auto some = [count](std::span<const float> from, std::size_t p) {
    if (p + width <= count) return load<F>(&from[p]);
    F v{};
    for (std::size_t i = 0; p + i < count; ++i) v[i] = from[p + i];
    return v;
  };
  const auto put = [count](std::span<float> to, std::size_t p, F v) {
    if (p + width <= count) return store(&to[p], v);
    for (std::size_t i = 0; p + i < count; ++i) to[p + i] = v[i];
  };
  for (std::size_t p = 0; p < count; p += width) {
    const Sample found = sample<Kind, Asked>(
        sampler, {some(points.x, p) * per_cell + ox, some(points.y, p) * per_cell + oy,
                  some(points.z, p) * per_cell + oz});
    if constexpr (Asked != Ask::normal) put(answers.distance, p, found.distance_or_far());
    if constexpr (Asked != Ask::distance) {
      put(answers.nx, p, found.normal.x);
      put(answers.ny, p, found.normal.y);
      put(answers.nz, p, found.normal.z);
    }
  }
}

template <LookUp Kind>
void fill(const auto& sampler, const Grid& grid, const Points& points, const Answers& answers) {
  if (answers.nx.empty()) return fill<Kind, Ask::distance>(sampler, grid, points, answers);
  if (answers.distance.empty()) return fill<Kind, Ask::normal>(sampler, grid, points, answers);
  fill<Kind, Ask::both>(sampler, grid, points, answers);
}

/// Returns whether anything is asked for.
bool check(const Grid& grid, bool has_normals, LookUp kind, const Points& points,
           const Answers& answers) {
  const std::size_t count = points.x.size();
  TESS_CHECK(points.y.size() == count && points.z.size() == count, "expected ", count,
             " coordinates on each axis");
  TESS_CHECK(answers.distance.empty() || answers.distance.size() == count, "expected room for ",
             count, " distances");
  for (const auto& normal : {answers.nx, answers.ny, answers.nz})
    TESS_CHECK(normal.size() == answers.nx.size() && (normal.empty() || normal.size() == count),
               "expected room for ", count, " normals on each axis, or none");
  TESS_CHECK(grid.size() < (std::size_t{1} << 31U), "voxels are numbered in 31 bits");
  if (count == 0 || (answers.distance.empty() && answers.nx.empty())) return false;
  if ((!answers.nx.empty() || kind == LookUp::tangent) && !has_normals)
    fail(ErrorCode::bad_argument, "normals are asked of a field of ", grid.size(),
         " voxels that stores none; build it with distance and normal");
  return true;
}

}  // namespace

void look_up(const Field& field, LookUp kind, const Points& points, const Answers& answers) {
  if (!check(field.grid, !field.normal.empty(), kind, points, answers)) return;
  const Sampler sampler = sampler_of(field);
  if (kind == LookUp::nearest) fill<LookUp::nearest>(sampler, field.grid, points, answers);
  if (kind == LookUp::tangent) fill<LookUp::tangent>(sampler, field.grid, points, answers);
  if (kind == LookUp::trilinear) fill<LookUp::trilinear>(sampler, field.grid, points, answers);
}

void look_up(const CompressedField& field, LookUp kind, const Points& points,
             const Answers& answers) {
  const bool has_normals = field.content == Content::distance_and_normal;
  if (!check(field.grid, has_normals, kind, points, answers)) return;
  if (kind == LookUp::trilinear)
    fail(ErrorCode::bad_argument,
         "a compressed field has no trilinear look-up; take nearest or tangent");
  const PlaneSampler sampler = sampler_of(field);
  if (kind == LookUp::nearest) return fill<LookUp::nearest>(sampler, field.grid, points, answers);
  fill<LookUp::tangent>(sampler, field.grid, points, answers);
}

}  // namespace tess::dn
