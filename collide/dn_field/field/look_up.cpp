#include "collide/dn_field/look_up.hpp"

#include "collide/dn_field/field/compressed_sample.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

namespace tess::dn {
namespace {

using namespace lanes;

template <LookUp Kind, Ask Asked>
void fill(const auto& given, const Grid& grid, const Points& points, const Answers& answers) {
  const auto sampler = given;  // a copy that no store can change
  const auto per_cell = static_cast<float>(1 / grid.cell);
  const auto ox = static_cast<float>(-grid.origin.x / grid.cell),
             oy = static_cast<float>(-grid.origin.y / grid.cell),
             oz = static_cast<float>(-grid.origin.z / grid.cell);
  const std::size_t count = points.x.size();
  const auto at = [&](F x, F y, F z) {
    Sample found =
        sample<Kind, Asked>(sampler, {x * per_cell + ox, y * per_cell + oy, z * per_cell + oz});
    found.distance = found.distance_or_far();
    return found;
  };
  const auto put = [&](const auto& write, const Sample& found) {
    if (!answers.distance.empty()) write(answers.distance, found.distance);
    if constexpr (Asked == Ask::both) {
      write(answers.nx, found.normal.x);
      write(answers.ny, found.normal.y);
      write(answers.nz, found.normal.z);
    }
  };
  std::size_t p = 0;
  for (; p + width <= count; p += width)
    put([p](std::span<float> to, F v) { store(&to[p], v); },
        at(load<F>(&points.x[p]), load<F>(&points.y[p]), load<F>(&points.z[p])));
  if (p == count) return;
  F x{}, y{}, z{};
  for (std::size_t i = 0; p + i < count; ++i)
    x[i] = points.x[p + i], y[i] = points.y[p + i], z[i] = points.z[p + i];
  const auto write_some = [=](std::span<float> to, F v) {
    for (std::size_t i = 0; p + i < count; ++i) to[p + i] = v[i];
  };
  put(write_some, at(x, y, z));
}

/// Returns whether anything is asked for.
bool check(const Field& field, LookUp kind, const Points& points, const Answers& answers) {
  const std::size_t count = points.x.size();
  TESS_CHECK(points.y.size() == count && points.z.size() == count, "expected ", count,
             " coordinates on each axis");
  TESS_CHECK(answers.distance.empty() || answers.distance.size() == count, "expected room for ",
             count, " distances");
  for (const auto& normal : {answers.nx, answers.ny, answers.nz})
    TESS_CHECK(normal.size() == answers.nx.size() && (normal.empty() || normal.size() == count),
               "expected room for ", count, " normals on each axis, or none");
  TESS_CHECK(field.grid.size() < (std::size_t{1} << 31U), "voxels are numbered in 31 bits");
  if (count == 0 || (answers.distance.empty() && answers.nx.empty())) return false;
  if (field.planes == nullptr &&
      (field.distance.empty() || field.distance.size() != field.grid.size()))
    fail(ErrorCode::bad_argument, "a look-up in a field of ", field.grid.size(), " voxels with ",
         field.distance.size(), " distances; build the field");
  if ((!answers.nx.empty() || kind == LookUp::tangent) && field.content() == Content::distance)
    fail(ErrorCode::bad_argument, "normals are asked of a field of ", field.grid.size(),
         " voxels that stores none; build it with distance and normal");
  if (field.planes != nullptr && kind == LookUp::trilinear)
    fail(ErrorCode::bad_argument,
         "a compressed field has no trilinear look-up; take nearest or tangent");
  return true;
}

}  // namespace

void look_up(const Field& field, LookUp kind, const Points& points, const Answers& answers) {
  if (!check(field, kind, points, answers)) return;
  const Ask ask = answers.nx.empty() ? Ask::distance : Ask::both;
  with<LookUp::nearest, LookUp::tangent, LookUp::trilinear>(kind, [&]<LookUp Kind> {
    with<Ask::distance, Ask::both>(ask, [&]<Ask Asked> {
      if (field.planes == nullptr)
        fill<Kind, Asked>(sampler_of(field), field.grid, points, answers);
      else if constexpr (Kind != LookUp::trilinear)
        fill<Kind, Asked>(plane_sampler_of(field), field.grid, points, answers);
    });
  });
}

}  // namespace tess::dn
