#include "m2m/couple/transposed_search.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace tess::m2m {

Addressed<SearchAnswer> donated(CouplingId id, const MeshView& mesh, const TargetFound& found,
                                collide::OwnerId me, std::uint64_t& n_lost) {
  Addressed<SearchAnswer> out;
  std::vector<std::uint8_t> has_donor(found.status.size(), 0);
  found.given.for_sources([&](collide::OwnerId piece, std::span<const std::uint32_t> places) {
    DonatedPoints points;
    for (const std::uint32_t place : places) {
      points.ids.push_back(mesh.point_ids[place]);
      points.points.push_back(static_cast<VertexId>(place));
      has_donor[place] = 1;
    }
    if (!places.empty()) out.emplace_back(piece, SearchAnswer{id, {}, std::move(points)});
  });
  std::map<collide::OwnerId, TransposedWeights> weights;
  for (const PlaceWeight& w : found.given.weights()) {
    has_donor[w.place] = 1;
    if (w.weight != 0)
      weights[w.source].weights.push_back(
          {w.vertex, static_cast<VertexId>(w.place), mesh.point_ids[w.place], me, w.weight});
  }
  for (auto& [piece, of_piece] : weights)
    out.emplace_back(piece, SearchAnswer{id, {}, std::move(of_piece)});
  n_lost = static_cast<std::uint64_t>(std::count(has_donor.begin(), has_donor.end(), 0));
  return out;
}

TransposedSearch::TransposedSearch(Addressed<Rows<double>> rows) {
  for (auto& [piece, of_piece] : rows) rows_[piece] = std::move(of_piece);
}

std::vector<PointReport> TransposedSearch::point_reports(const MeshView& mesh,
                                                         collide::OwnerId me) const {
  std::vector<VertexId> ghosts;
  for (const auto& [piece, rows] : rows_)
    for (const VertexId v : rows.columns)
      if (v >= mesh.n_owned) ghosts.push_back(v);
  sort_unique(ghosts);
  // The directory compares numbers of tetrahedra: here there are none.
  std::vector<PointReport> reports;
  for (VertexId v = 0; v < mesh.n_owned; ++v)
    reports.push_back({mesh.point_ids[static_cast<std::size_t>(v)], me, v, 0, 0, 0});
  for (const VertexId v : ghosts)
    reports.push_back({mesh.point_ids[static_cast<std::size_t>(v)], me, v, 0, -1, 0});
  return reports;
}

void TransposedSearch::add(SearchAnswer answer) {
  if (const auto* shared = std::get_if<SharedPoints>(&answer.what)) {
    for (const SharedPoint& point : shared->points)
      if (!point.is_owner) owners_[point.point] = {point.other, point.there};
  } else if (auto* points = std::get_if<DonatedPoints>(&answer.what)) {
    points_[answer.from] = std::move(*points);
  } else {
    const auto& weights = std::get<TransposedWeights>(answer.what).weights;
    weights_.insert(weights_.end(), weights.begin(), weights.end());
  }
}

SearchStep TransposedSearch::next(const CouplingSetup& setup, const MeshView& mesh,
                                  TargetFound& found) {
  SearchStep step;
  if (!std::exchange(has_passed_, true)) {
    step.beside = pass_on(setup.id, mesh);
  } else {
    finish(setup, mesh, found, step);
    step.then = SearchStep::Then::nothing;
  }
  return step;
}

Addressed<SearchAnswer> TransposedSearch::pass_on(CouplingId id, const MeshView& mesh) {
  std::map<collide::OwnerId, TransposedWeights> ghosts;
  for (const auto& [piece, rows] : rows_) {
    if (rows.n_rows() == 0) continue;  // the target applies the rows of this kind
    const auto points = points_.find(piece);
    TESS_CHECK(points != points_.end() && points->second.ids.size() == rows.n_rows(),
               "a piece holds donors of another search than the piece that has the points: search "
               "the coupling that was transposed, and then this one");
    const DonatedPoints& of_rows = points->second;
    for (std::size_t row = 0; row < rows.n_rows(); ++row)
      for (std::uint64_t k = rows.begin[row]; k < rows.begin[row + 1]; ++k) {
        if (rows.weights[k] == 0) continue;  // so that it takes nothing of a NaN
        TransposedWeight weight{rows.columns[k], of_rows.points[row], of_rows.ids[row], piece,
                                rows.weights[k]};
        if (weight.vertex < mesh.n_owned) {
          weights_.push_back(weight);
          continue;
        }
        const GhostOwner& owner = owners_.at(weight.vertex);
        weight.vertex = owner.vertex;
        ghosts[owner.piece].weights.push_back(weight);
      }
  }
  rows_ = {};
  points_ = {};
  owners_ = {};
  Addressed<SearchAnswer> out;
  for (auto& [piece, weights] : ghosts)
    out.emplace_back(piece, SearchAnswer{id, {}, std::move(weights)});
  return out;
}

void TransposedSearch::finish(const CouplingSetup& setup, const MeshView& mesh, TargetFound& found,
                              SearchStep& step) {
  // A point may have two weights for a vertex that its donor names twice: they come from one piece,
  // in their order.
  std::stable_sort(weights_.begin(), weights_.end(),
                   [](const TransposedWeight& a, const TransposedWeight& b) {
                     return std::tie(a.vertex, a.point_id) < std::tie(b.vertex, b.point_id);
                   });
  found.status.assign(static_cast<std::size_t>(mesh.n_owned), Status::outside);
  std::vector<PlaceWeight> rows;
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    const TransposedWeight& w = weights_[k];
    if (k > 0 && weights_[k - 1].vertex == w.vertex && weights_[k - 1].point_id == w.point_id &&
        (weights_[k - 1].piece != w.piece || weights_[k - 1].point != w.point))
      fail(ErrorCode::bad_mesh, "the force of point ", w.point_id,
           " would count twice, since two pieces own the point: let one piece own each (view_of() "
           "for a MeshPiece)");
    found.status[static_cast<std::size_t>(w.vertex)] = Status::inside;
    rows.push_back({static_cast<std::uint32_t>(w.vertex), w.point, w.piece, w.weight});
  }
  for (const Status status : found.status) ++found.tally.counts[static_cast<std::size_t>(status)];
  for (auto& [piece, points] : found.given.keep_weights(rows))
    step.choices.emplace_back(piece, Choice{setup.id, {}, {}, std::move(points)});
}

}  // namespace tess::m2m
