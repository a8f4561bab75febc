#include "m2m/field_norms.hpp"

#include "m2m/mesh/workers/value_keeper.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tess::m2m {
namespace {

/// The sum of two, rounded once.
double total(ExactSum a, const ExactSum& b) {
  a.add(b);
  return a.total();
}

ErrorNorms norms_of(const SquareSums& sums, bool underflows, double plain,
                    const LargestError& worst, std::uint64_t n_vertices) {
  ErrorNorms norms;
  norms.n_vertices = n_vertices;
  if (n_vertices == 0) {
    norms.l2 = norms.l2_relative = norms.rms = norms.linf =
        std::numeric_limits<double>::quiet_NaN();
    return norms;
  }
  const double reference = sums.truth.total();
  norms.l2 = std::sqrt(sums.error.total());
  norms.l2_relative = reference > 0 ? norms.l2 / std::sqrt(reference) : norms.l2;
  norms.rms = std::sqrt(plain / static_cast<double>(n_vertices));
  norms.linf = worst.error;
  norms.worst = worst.vertex;
  // Squares, and their products with volumes, that leave the range of double say nothing.
  constexpr double least = 1e-280;  // of terms that are not zero, with digits to spare
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const bool lost = underflows && std::max(reference, sums.error.total()) < least;
  if (lost || std::isinf(norms.l2) || std::isinf(reference)) norms.l2 = norms.l2_relative = nan;
  if ((norms.rms == 0 && worst.error > 0) || std::isinf(norms.rms)) norms.rms = nan;
  return norms;
}

FieldNorms norms_of(const ComponentSums& sums, const NormSums& whole) {
  SquareSums all = sums.same, found = sums.same;
  all.add(sums.all);
  found.add(sums.found);
  FieldNorms norms;
  norms.all = norms_of(all, sums.underflows, total(sums.plain_found, sums.plain_outside),
                       sums.worst, whole.n_vertices);
  norms.found =
      norms_of(found, sums.underflows, sums.plain_found.total(), sums.worst_found, whole.n_found);
  norms.worst_at = sums.worst.at;
  norms.integral = sums.value.total();
  norms.l2 = std::sqrt(sums.value_squared.total());
  norms.truth_integral = sums.truth.total();
  norms.truth_l2 = std::sqrt(all.truth.total());
  norms.truth_magnitude = sums.truth_magnitude.total();
  return norms;
}

}  // namespace

TaskOf<std::vector<FieldNorms>> measure_norms(DistributedMesh mesh, std::string name,
                                              std::vector<FormulaField> truth,
                                              std::vector<RigidMotion> back) {
  const NormsRequest request{std::move(name), std::move(truth), std::move(back)};
  if (request.truth.size() != mesh.n_components)
    fail(ErrorCode::bad_argument, request.mesh, " has ", mesh.n_components, " components, and ",
         request.truth.size(), " formulas are given; give one per component");
  for (const FormulaField& field : request.truth) (void)make_formula(field.name, field.domain);
  co_await epoch([&] { mesh.workers.broadcast<&Worker::share_status>(); });
  const NormSums sums = co_await mesh.workers.reduce<&Worker::measure>(request);
  if (const NotFinite& bad = sums.refused; bad.component >= 0)
    throw Error(ErrorCode::bad_value,
                not_finite_text(request.truth[static_cast<std::size_t>(bad.component)].name,
                                bad.value, bad.vertex, request.mesh, bad.at));
  std::vector<FieldNorms> norms;
  for (const ComponentSums& one : sums.components) norms.push_back(norms_of(one, sums));
  co_return norms;
}

std::vector<FieldColumns> scalar_columns(std::uint64_t n) {
  std::vector<FieldColumns> columns;
  for (std::uint64_t c = 0; c < n; ++c) columns.push_back({c, 1});
  return columns;
}

TaskOf<std::uint64_t> hash_values(DistributedMesh mesh, GlobalId n_vertices,
                                  std::vector<FieldColumns> fields) {
  for (const FieldColumns& field : fields)
    TESS_CHECK(field.first + field.n <= mesh.n_components, "a field has components up to ",
               field.first + field.n, ", the mesh has ", mesh.n_components);
  const auto keepers = create<ValueKeeper>(each_pe, n_vertices, std::uint64_t{mesh.n_components});
  co_await epoch([&] { mesh.workers.broadcast<&Worker::send_values>(keepers, n_vertices); });
  std::uint64_t so_far = result_hash({});
  for (const FieldColumns& field : fields)
    for (std::int32_t pe = 0; pe < n_pes(); ++pe) {
      const HashStart start{field.first, field.n, so_far};
      so_far = co_await keepers[PeId{pe}].ask<&ValueKeeper::extend>(start);
    }
  keepers.destroy();
  co_return so_far;
}

}  // namespace tess::m2m
