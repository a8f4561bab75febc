// Conservative kinds: the rows by which a source piece computes the loads of target pieces.
#include "m2m/couple/source_side.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <utility>

namespace tess::m2m {

OverlapAnswer SourceSide::answer_overlaps(const MeshView& mesh, collide::OwnerId target,
                                          const TargetTets& tets, std::uint64_t& n_tested) {
  require_dimensions(setup.kind, setup.tolerance, mesh.dimension, tets.dimension);
  OverlapRows found = overlap_rows(mesh, setup.source_values, cover_, tets);
  n_tested += found.n_tested;
  OverlapAnswer answer{std::move(found.tets), std::move(found.covered), {}};
  Rows<double> rows;
  for (std::size_t row = 0; row < found.rows.n_rows(); ++row) {
    if (found.rows.columns_of(row).empty()) continue;
    answer.rows.push_back(static_cast<std::uint32_t>(row));
    rows.begin.push_back(found.rows.begin[row + 1]);
  }
  rows.columns = std::move(found.rows.columns);
  rows.weights = std::move(found.rows.weights);
  if (!answer.rows.empty()) given_[target].rows = std::move(rows);
  return answer;
}

PartialRows SourceSide::choose_rows(const MeshView& mesh, const Choice& choice) {
  Given& given = given_.at(choice.from);
  const Rows<double> all = std::exchange(given.rows, {});
  PartialRows partial;
  auto kept = choice.kept.begin();
  const auto id_of = [&](VertexId u) { return id_of_unknown(mesh, setup.source_values, u); };
  for (std::size_t row = 0; row < all.n_rows(); ++row) {
    const auto columns = all.columns_of(row);
    const auto weights = all.weights_of(row);
    if (kept != choice.kept.end() && *kept == row) {
      ++kept;
      for (std::size_t k = 0; k < columns.size(); ++k) given.rows.add(columns[k], weights[k]);
      given.rows.end_row();
    } else {
      given.sent.insert(given.sent.end(), columns.begin(), columns.end());
      partial.weights.insert(partial.weights.end(), weights.begin(), weights.end());
      partial.first.push_back(static_cast<std::uint32_t>(partial.weights.size()));
    }
  }
  const std::vector<VertexId> unknowns = given.sent;
  std::sort(given.sent.begin(), given.sent.end(),
            [&](VertexId a, VertexId b) { return id_of(a) < id_of(b); });
  given.sent.erase(std::unique(given.sent.begin(), given.sent.end()), given.sent.end());
  for (const VertexId u : given.sent) {
    // The target would add up the weights of both.
    TESS_CHECK(partial.ids.empty() || partial.ids.back() != id_of(u), "two ",
               rows_of(setup.source_values), " of a piece have the id ", id_of(u),
               ": point_ids and tet_ids are unique in the mesh");
    partial.ids.push_back(id_of(u));
  }
  for (const VertexId u : unknowns)
    partial.columns.push_back(static_cast<std::uint32_t>(
        std::lower_bound(partial.ids.begin(), partial.ids.end(), id_of(u)) - partial.ids.begin()));
  return partial;
}

std::vector<double> SourceSide::loads(const Given& given, std::span<const double> values,
                                      std::size_t n_components) const {
  const std::size_t n_loads = given.rows.n_rows() * n_components;
  std::vector<double> out(n_loads);
  m2m::apply(given.rows, values, n_components, out);
  if (setup.kind == TransferKind::conservative_bounded) {
    std::vector<ValueRange> ranges(n_loads);
    value_ranges(given.rows, values, n_components, ranges);
    for (const ValueRange& range : ranges) out.insert(out.end(), {range.low, range.high});
  }
  for (const VertexId u : given.sent) {
    const auto row = values.subspan(static_cast<std::size_t>(u) * n_components, n_components);
    out.insert(out.end(), row.begin(), row.end());
  }
  return out;
}

}  // namespace tess::m2m
