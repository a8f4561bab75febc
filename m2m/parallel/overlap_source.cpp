#include "m2m/parallel/overlap_source.hpp"

#include "runtime/core/check.hpp"

#include <limits>
#include <utility>

namespace tess::m2m {

std::vector<Aabb> OverlapSource::start_search(const MeshView& mesh) {
  validate(mesh);
  given_.clear();
  rounds_.clear();
  cover_ = cover_tets(mesh.points, mesh.own_tets());
  return cover_.boxes;
}

OverlapAnswer OverlapSource::answer(const MeshView& mesh, const OverlapQuery& query) {
  Overlaps found = find_overlaps(mesh, cover_, query.tets);
  OverlapAnswer answer{setup.id, {}, found.targets, found.first, {}, found.n_tested};
  for (const std::int32_t tet : found.sources)
    answer.ids.push_back(mesh.tet_ids[static_cast<std::size_t>(tet)]);
  if (!found.targets.empty()) given_[query.from].overlaps = std::move(found);
  return answer;
}

GivenValues OverlapSource::share(const MeshView& mesh, SharedTets shared) {
  Given& given = given_.at(shared.from);
  given.shared = std::move(shared.shared);
  const std::vector<double> ones(mesh.tets.size(), 1.0);
  return {setup.id, {}, 0, 0, loads(mesh, given, {ones, 1, Centring::cells}, false)};
}

SourceField OverlapSource::field_of(const MeshView& mesh, std::span<const double> values) const {
  const Centring centring = setup.source_values;
  const std::size_t n_rows = centring == Centring::nodes   ? mesh.points.size()
                             : centring == Centring::cells ? mesh.tets.size()
                                                           : 4 * mesh.tets.size();
  if (n_rows == 0) return {values, 1, centring};
  TESS_CHECK(values.size() % n_rows == 0, "a piece with ", n_rows, " ",
             centring == Centring::nodes   ? "points"
             : centring == Centring::cells ? "tetrahedra"
                                           : "corners of tetrahedra",
             " gives ", values.size(), " values: give as many rows, ghosts included");
  return {values, values.size() / n_rows, centring};
}

std::vector<double> OverlapSource::loads(const MeshView& mesh, const Given& given,
                                         const SourceField& field, bool with_ranges) const {
  const std::size_t n = field.n_components;
  const bool to_cells = setup.target_values == Centring::cells;
  const bool ranges = with_ranges && setup.kind == TransferKind::conservative_bounded;
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::vector<double> out, block(4 * n, 0);
  std::vector<ValueRange> range(n, {inf, -inf});
  const auto end_block = [&] {
    if (to_cells) {
      for (std::size_t c = 0; c < n; ++c)
        out.push_back((block[c] + block[n + c]) + (block[2 * n + c] + block[3 * n + c]));
    } else {
      out.insert(out.end(), block.begin(), block.end());
    }
    block.assign(4 * n, 0);
    if (!ranges) return;
    for (const ValueRange& r : range) out.insert(out.end(), {r.low, r.high});
    range.assign(n, {inf, -inf});
  };
  const Overlaps& all = given.overlaps;
  for (std::size_t t = 0; t < all.targets.size(); ++t) {
    for (std::uint32_t k = all.first[t]; k < all.first[t + 1]; ++k) {
      add_load(mesh, all.sources[k], all.integrals[k], field, block);
      if (ranges) add_range(mesh, all.sources[k], field, range);
      if (given.shared[t] != 0) end_block();
    }
    if (given.shared[t] == 0) end_block();
  }
  return out;
}

}  // namespace tess::m2m
