#include "collide/dn_field/look_up.hpp"

#include "collide/dn_field/field/sample.hpp"
#include "runtime/core/check.hpp"

#include <array>

namespace tess::dn {
namespace {

using namespace lanes;

/// Fills whole vectors; the last points are copied to one of their own.
template <LookUp Kind, Ask Asked>
void answer(const Field& field, const Points& points, const Answers& answers) {
  const Sampler sampler = sampler_of(field);
  const auto& grid = field.grid;
  const auto per_cell = static_cast<float>(1 / grid.cell);
  const auto ox = static_cast<float>(-grid.origin.x / grid.cell),
             oy = static_cast<float>(-grid.origin.y / grid.cell),
             oz = static_cast<float>(-grid.origin.z / grid.cell);
  const auto at = [&](const float* x, const float* y, const float* z) {
    Sample found = sample<Kind, Asked>(
        sampler,
        {load<F>(x) * per_cell + ox, load<F>(y) * per_cell + oy, load<F>(z) * per_cell + oz});
    found.distance = found.distance_or_far();
    return found;
  };
  const std::size_t count = points.x.size();
  std::size_t p = 0;
  for (; p + width <= count; p += width) {
    const Sample found = at(&points.x[p], &points.y[p], &points.z[p]);
    if constexpr (Asked != Ask::normal) store(&answers.distance[p], found.distance);
    if constexpr (Asked != Ask::distance) {
      store(&answers.nx[p], found.normal.x);
      store(&answers.ny[p], found.normal.y);
      store(&answers.nz[p], found.normal.z);
    }
  }
  if (p == count) return;
  std::array<float, width> x{}, y{}, z{};
  for (std::size_t i = 0; p + i < count; ++i)
    x[i] = points.x[p + i], y[i] = points.y[p + i], z[i] = points.z[p + i];
  const Sample found = at(x.data(), y.data(), z.data());
  for (std::size_t i = 0; p + i < count; ++i) {
    if constexpr (Asked != Ask::normal) answers.distance[p + i] = found.distance[i];
    if constexpr (Asked != Ask::distance) {
      answers.nx[p + i] = found.normal.x[i];
      answers.ny[p + i] = found.normal.y[i];
      answers.nz[p + i] = found.normal.z[i];
    }
  }
}

template <LookUp Kind>
void answer(const Field& field, const Points& points, const Answers& answers) {
  if (answers.nx.empty()) return answer<Kind, Ask::distance>(field, points, answers);
  if (answers.distance.empty()) return answer<Kind, Ask::normal>(field, points, answers);
  answer<Kind, Ask::both>(field, points, answers);
}

}  // namespace

void look_up(const Field& field, LookUp kind, const Points& points, const Answers& answers) {
  const std::size_t count = points.x.size();
  TESS_CHECK(points.y.size() == count && points.z.size() == count, "expected ", count,
             " coordinates on each axis");
  TESS_CHECK(answers.distance.empty() || answers.distance.size() == count, "expected room for ",
             count, " distances");
  for (const auto& normal : {answers.nx, answers.ny, answers.nz})
    TESS_CHECK(normal.size() == answers.nx.size() && (normal.empty() || normal.size() == count),
               "expected room for ", count, " normals on each axis, or none");
  TESS_CHECK(field.grid.size() < (std::size_t{1} << 31U), "voxels are numbered in 32 bits");
  if (count == 0 || (answers.distance.empty() && answers.nx.empty())) return;
  if ((!answers.nx.empty() || kind == LookUp::tangent) && field.normal.empty())
    fail(ErrorCode::bad_argument, "normals are asked of a field of ", field.grid.size(),
         " voxels that stores none; build it with distance and normal");
  if (kind == LookUp::nearest) answer<LookUp::nearest>(field, points, answers);
  if (kind == LookUp::tangent) answer<LookUp::tangent>(field, points, answers);
  if (kind == LookUp::trilinear) answer<LookUp::trilinear>(field, points, answers);
}

void nearest_distance(const Field& field, const Points& points, std::span<float> distance) {
  look_up(field, LookUp::nearest, points, {distance, {}, {}, {}});
}

}  // namespace tess::dn
