#include "tests/m2m/serial_transfer.hpp"

#include "m2m/rows/interpolate/locate.hpp"
#include "m2m/rows/search/nearest_vertex.hpp"
#include "runtime/core/check.hpp"
#include "tests/m2m/cell_grid.hpp"

#include <algorithm>
#include <optional>

namespace tess::test {

using namespace m2m;

namespace {

/// The best candidate for a target vertex.
struct Winner {
  Candidate candidate;
  Weights weights{};
};

std::vector<Winner> search(const TetMesh& source, const TetMesh& target,
                           std::uint64_t& n_candidates) {
  std::vector<Aabb> boxes;
  boxes.reserve(source.n_tets());
  for (const Tet& tet : source.tets) boxes.push_back(search_box(corners_of(source.points, tet)));
  const CellGrid grid(bounds(source), source.n_tets() / 2, boxes);

  std::vector<Winner> winners(target.n_points());
  std::vector<PointPair> pairs;
  std::vector<Found> found;
  const auto flush = [&] {
    found.clear();
    locate_pairs(source.points, source.tets, target.points, pairs, found);
    for (const Found& f : found) {
      const PointPair& pair = pairs[static_cast<std::size_t>(f.pair)];
      Winner& winner = winners[static_cast<std::size_t>(pair.point)];
      const Candidate candidate = candidate_of(f.location, pair.tet);
      if (better(candidate, winner.candidate)) winner = {candidate, f.location.weights};
    }
    n_candidates += pairs.size();
    pairs.clear();
  };
  for (std::size_t v = 0; v < target.n_points(); ++v) {
    const Point& p = target.points[v];
    for (const std::int32_t t : grid.items(grid.cell_of(p)))
      if (overlap(boxes[static_cast<std::size_t>(t)], collide::box_of(p),
                  collide::Touching::counts))
        pairs.push_back({t, static_cast<std::int32_t>(v)});
    if (pairs.size() > 2048) flush();
  }
  flush();
  return winners;
}

void copy_row(const Field& from, std::size_t source_row, Field& to, std::size_t target_row) {
  std::copy_n(from.values.data() + source_row * from.n_components, from.n_components,
              to.values.data() + target_row * to.n_components);
}

}  // namespace

SerialReport transfer_serial(const TetMesh& source, std::span<const Field> source_fields,
                             const TetMesh& target, std::span<Field> target_fields,
                             const OutsidePolicy& policy) {
  TESS_CHECK(source_fields.size() == target_fields.size(), "expected ", source_fields.size(),
             " target fields, got ", target_fields.size());
  for (std::size_t f = 0; f < source_fields.size(); ++f) {
    const std::size_t n = source_fields[f].n_components;
    TESS_CHECK(target_fields[f].n_components == n &&
                   source_fields[f].values.size() == n * source.n_points() &&
                   target_fields[f].values.size() == n * target.n_points(),
               "field ", source_fields[f].name, ": expected ", n,
               " components per vertex on both meshes");
  }
  SerialReport report;
  const std::vector<Winner> winners = search(source, target, report.n_candidates);
  report.status.resize(target.n_points());
  report.tet.assign(target.n_points(), -1);
  std::optional<NearestVertex> nearest;
  for (std::size_t v = 0; v < target.n_points(); ++v) {
    const Winner& winner = winners[v];
    report.status[v] = winner.candidate.status;
    ++report.counts[static_cast<std::size_t>(winner.candidate.status)];
    if (winner.candidate.status != Status::outside) {
      report.tet[v] = winner.candidate.tet;
      const Tet& tet = source.tets[static_cast<std::size_t>(winner.candidate.tet)];
      for (std::size_t f = 0; f < source_fields.size(); ++f) {
        const std::size_t n = source_fields[f].n_components;
        for (std::size_t c = 0; c < n; ++c) {
          target_fields[f].values[v * n + c] =
              interpolated(winner.weights, tet, source_fields[f].values.data() + c, n);
        }
      }
    } else if (const auto* given = std::get_if<UseValue>(&policy)) {
      for (Field& field : target_fields)
        std::fill_n(field.values.data() + v * field.n_components, field.n_components, given->value);
    } else if (std::holds_alternative<Nearest>(policy)) {
      if (!nearest) nearest.emplace(source.points);
      const auto row = static_cast<std::size_t>(nearest->find(target.points[v]).vertex);
      for (std::size_t f = 0; f < source_fields.size(); ++f)
        copy_row(source_fields[f], row, target_fields[f], v);
    }
  }
  return report;
}

}  // namespace tess::test
