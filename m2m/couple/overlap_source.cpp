#include "m2m/couple/overlap_source.hpp"

#include "runtime/core/check.hpp"

#include <algorithm>
#include <utility>

namespace tess::m2m {

std::vector<Aabb> OverlapSource::start_search(const MeshView& mesh) {
  validate(mesh);
  given_.clear();
  rounds_.clear();
  rows_of_search_.set(mesh, setup.source_values);
  cover_ = cover_tets(mesh.points, mesh.own_tets());
  return cover_.boxes;
}

OverlapAnswer OverlapSource::answer(const MeshView& mesh, const OverlapQuery& query) {
  OverlapRows found = overlap_rows(mesh, setup.source_values, cover_, query.tets);
  OverlapAnswer answer{setup.id,      {}, std::move(found.tets), std::move(found.covered), {},
                       found.n_tested};
  Rows<double> rows;
  for (std::size_t row = 0; row < found.rows.n_rows(); ++row) {
    if (found.rows.columns_of(row).empty()) continue;
    answer.rows.push_back(static_cast<std::uint32_t>(row));
    rows.begin.push_back(found.rows.begin[row + 1]);
  }
  rows.columns = std::move(found.rows.columns);
  rows.weights = std::move(found.rows.weights);
  if (!answer.rows.empty()) given_[query.from].rows = std::move(rows);
  return answer;
}

PartialRows OverlapSource::share(const MeshView& mesh, const SharedRows& shared) {
  Given& given = given_.at(shared.from);
  const Rows<double> all = std::exchange(given.rows, {});
  PartialRows partial{setup.id, {}, {}, {0}, {}, {}};
  const auto id_of = [&](VertexId u) { return id_of_unknown(mesh, setup.source_values, u); };
  for (std::size_t row = 0; row < all.n_rows(); ++row) {
    const auto columns = all.columns_of(row);
    const auto weights = all.weights_of(row);
    if (shared.shared[row] != 0) {
      for (std::size_t k = 0; k < columns.size(); ++k) {
        given.sent.push_back(columns[k]);
        partial.weights.push_back(weights[k]);
      }
      partial.first.push_back(static_cast<std::uint32_t>(partial.weights.size()));
    } else {
      for (std::size_t k = 0; k < columns.size(); ++k) given.rows.add(columns[k], weights[k]);
      given.rows.end_row();
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

std::size_t OverlapSource::components_of(const MeshView& mesh,
                                         std::span<const double> values) const {
  const Centring centring = setup.source_values;
  const std::size_t n_rows = n_unknowns(mesh, centring);
  if (n_rows == 0) return 1;
  TESS_CHECK(values.size() % n_rows == 0, "a piece with ", n_rows, " ", rows_of(centring),
             " gives ", values.size(), " values: give as many rows, ghosts included");
  return values.size() / n_rows;
}

std::vector<double> OverlapSource::loads(const Given& given, std::span<const double> values,
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
