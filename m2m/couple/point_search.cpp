#include "m2m/couple/point_search.hpp"

#include "collide/hit_receivers.hpp"
#include "m2m/rows/search/nearest_cells.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tess::m2m {

std::vector<Aabb> PointSearch::start(const CouplingSetup& setup, const MeshView& mesh) {
  // Its tetrahedra are not looked at.
  validate(MeshView{mesh.points, {}, mesh.point_ids, {}, mesh.n_owned});
  best_.assign(static_cast<std::size_t>(mesh.n_owned), {});
  if (setup.fits()) fits_.emplace(setup.order, best_.size());
  if (!setup.collides()) return {};
  cover_ = cover_points(mesh.owned());
  return std::exchange(cover_.boxes, {});
}

void PointSearch::add(const collide::Hits& hits) {
  Asked& asked = asked_[hits.other];
  for (const collide::LocalPair& pair : hits.pairs) {
    asked.boxes.push_back(static_cast<std::uint32_t>(pair.mine));
    asked.source_boxes.push_back(static_cast<std::uint32_t>(pair.theirs));
  }
}

SearchStep PointSearch::next(const CouplingSetup& setup, const MeshView& mesh, TargetFound& found) {
  SearchStep step;
  if (stage_ == Stage::ask) {
    stage_ = Stage::locate;
    step.queries = point_queries(setup.id, mesh);
    if (!step.queries.empty()) return step;
  }
  if (stage_ == Stage::locate) {
    list_outside(setup.kind);
    if (!nearest_.empty()) {
      stage_ = Stage::name;
      step.then = SearchStep::Then::sources;
      return step;
    }
  }
  if (stage_ == Stage::ask_nearest) {
    step.queries = nearest_queries(setup, mesh);
    if (!step.queries.empty()) return step;
  }
  step.choices = choices(setup, mesh, found);
  step.then = SearchStep::Then::nothing;
  return step;
}

Addressed<SearchQuery> PointSearch::point_queries(CouplingId id, const MeshView& mesh) {
  Addressed<SearchQuery> out;
  for (auto& [source, asked] : asked_) {
    sort_unique_boxes(asked.boxes);
    sort_unique_boxes(asked.source_boxes);
    DonorQuery query{std::exchange(asked.source_boxes, {}), {}};
    for (const std::uint32_t box : asked.boxes)
      for (const std::uint32_t row : cover_.members_of(box)) {
        asked.rows.push_back(row);
        query.points.push_back(mesh.points[row]);
      }
    asked.boxes = {};
    out.emplace_back(source, SearchQuery{id, {}, std::move(query)});
  }
  cover_ = {};
  return out;
}

void PointSearch::add(const CouplingSetup& setup, collide::OwnerId from,
                      const DonorAnswer& answer) {
  Asked& asked = asked_.at(from);
  asked.held.reserve(answer.points.size());
  for (std::size_t i = 0; i < answer.points.size(); ++i) {
    const std::uint32_t row = asked.rows[answer.points[i]];
    asked.held.push_back(row);
    Best& best = best_[row];
    const Candidate& mine = answer.candidates[i];
    if (mine.tet == best.candidate.tet && mine.status != Status::outside)
      fail(ErrorCode::bad_mesh, "coupling ", static_cast<std::uint64_t>(setup.id),
           ": the source pieces ", collide::owner_text(best.source), " and ",
           collide::owner_text(from), " have tetrahedra of the same id ", mine.tet,
           ": tet_ids are unique in the mesh");
    if (better(mine, best.candidate)) best = {mine, from};
  }
  asked.rows = {};
}

void PointSearch::list_outside(TransferKind kind) {
  for (std::size_t v = 0; v < best_.size(); ++v)
    if (kind == TransferKind::nearest || fits_ || best_[v].candidate.status == Status::outside) {
      to_ask_.push_back(static_cast<std::uint32_t>(nearest_.size()));
      nearest_.push_back({.row = static_cast<std::uint32_t>(v)});
    }
}

void PointSearch::name_sources(const MeshView& mesh, std::span<const SourcePiece> sources) {
  std::vector<Aabb> boxes;
  // Points of pieces without tetrahedra count if no piece has any.
  const bool have_tets = std::any_of(sources.begin(), sources.end(),
                                     [](const SourcePiece& s) { return s.has_tets != 0; });
  for (const SourcePiece& source : sources) {
    const bool counts = source.has_tets != 0 || !have_tets;
    boxes.push_back(counts ? source.box : collide::no_box<double, 3>());
    sources_.push_back(source.owner);
  }
  source_has_points_ = std::any_of(sources.begin(), sources.end(),
                                   [](const SourcePiece& s) { return s.has_points != 0; });
  Aabb around = collide::no_box<double, 3>();
  for (const NearestSoFar& point : nearest_) grow(around, mesh.points[point.row]);
  nearest_parts_ = NearestParts(boxes, around);
  stage_ = Stage::ask_nearest;
}

Addressed<SearchQuery> PointSearch::nearest_queries(const CouplingSetup& setup,
                                                    const MeshView& mesh) {
  const bool of_cells = setup.seeks_nearest_cells();
  std::map<collide::OwnerId, NearestQuery> queries;
  std::map<collide::OwnerId, DonorQuery> cell_queries;
  std::erase_if(to_ask_, [&](std::uint32_t key) {
    NearestSoFar& so_far = nearest_[key];
    const Point& point = mesh.points[so_far.row];
    const NearestParts::RankedPart next = nearest_parts_.next(point, so_far.asked);
    const double distance = best_[so_far.row].candidate.distance;
    const double squared = of_cells ? squared_limit(distance) : so_far.squared_distance;
    if (next == NearestParts::none || next.squared_distance > squared) return true;
    so_far.asked = next;
    const collide::OwnerId source = sources_[static_cast<std::size_t>(next.number)];
    if (of_cells) {
      DonorQuery& query = cell_queries[source];
      asked_[source].rows.push_back(so_far.row);
      query.points.push_back(point);
      query.reaches.push_back(distance);
      return false;
    }
    NearestQuery& query = queries[source];
    if (fits_) query.n_nearest = static_cast<std::uint32_t>(fits_->n_wanted());
    query.keys.push_back(key);
    query.points.push_back(point);
    query.squared_reaches.push_back(so_far.squared_distance);
    return false;
  });
  Addressed<SearchQuery> out;
  for (auto& [source, query] : queries)
    out.emplace_back(source, SearchQuery{setup.id, {}, std::move(query)});
  for (auto& [source, query] : cell_queries)
    out.emplace_back(source, SearchQuery{setup.id, {}, std::move(query)});
  return out;
}

void PointSearch::add(collide::OwnerId from, const NearestAnswer& answer) {
  for (std::size_t i = 0; i < answer.keys.size(); ++i) {
    NearestSoFar& mine = nearest_[answer.keys[i]];
    const double d = answer.squared_distances[i];
    if (fits_) {
      mine.squared_distance = fits_->add(answer.keys[i], {d, answer.ids[i], answer.vertices[i]},
                                         answer.points[i], from);
      continue;
    }
    if (d > mine.squared_distance || (d == mine.squared_distance && answer.ids[i] >= mine.id))
      continue;
    mine.squared_distance = d;
    mine.id = answer.ids[i];
    mine.vertex = answer.vertices[i];
    mine.source = from;
  }
}

Addressed<Choice> PointSearch::choices(const CouplingSetup& setup, const MeshView& mesh,
                                       TargetFound& found) {
  if (fits_) return fit_choices(setup.id, mesh, found);
  found.status.resize(best_.size());
  found.distance.resize(best_.size());
  std::map<collide::OwnerId, std::vector<std::uint32_t>> rows;
  std::map<collide::OwnerId, Choice> all;
  for (auto& [source, asked] : asked_) {
    Choice& choice = all[source];
    if (setup.kind == TransferKind::nearest) continue;
    std::vector<std::uint32_t> mine;
    for (std::size_t i = 0; i < asked.held.size(); ++i) {
      if (best_[asked.held[i]].source != source) continue;
      choice.kept.push_back(static_cast<std::uint32_t>(i));
      mine.push_back(asked.held[i]);
    }
    if (!mine.empty()) rows[source] = std::move(mine);
  }
  for (std::size_t v = 0; v < best_.size(); ++v) {
    found.status[v] = best_[v].candidate.status;
    found.distance[v] = best_[v].candidate.distance;  // infinite if outside
    ++found.tally.counts[static_cast<std::size_t>(found.status[v])];
    if (best_[v].candidate.side == 0) continue;
    found.side.resize(best_.size());
    found.side[v] = best_[v].candidate.side;
  }
  const bool takes_outside = std::holds_alternative<Nearest>(setup.policy);
  if (setup.seeks_nearest_cells()) {
    if (source_has_points_ && found.tally.count(Status::outside) > 0)
      fail(ErrorCode::bad_mesh,
           "kind projection has no cell to project on: no source piece shows any; choose kind "
           "nearest for a source of points");
    nearest_.clear();
  }
  for (const NearestSoFar& nearest : nearest_) {
    const std::uint32_t row = nearest.row;
    const bool is_outside = found.status[row] == Status::outside;
    if (is_outside) found.distance[row] = std::sqrt(nearest.squared_distance);
    if (is_outside && !takes_outside) continue;
    if (nearest.vertex < 0) {
      if (!source_has_points_) continue;
      fail(
          ErrorCode::bad_mesh,
          "no source piece owns a point that is a corner of its tetrahedra, so that no point has a "
          "nearest vertex: set MeshView::n_owned in the source, too");
    }
    all[nearest.source].vertices.push_back(nearest.vertex);
    rows[nearest.source].push_back(row);
  }
  for (std::size_t v = 0; v < found.status.size(); ++v)
    if (found.status[v] >= Status::snapped)
      found.worst.add({mesh.point_ids[v], mesh.points[v], found.distance[v], found.status[v]});
  for (auto& [source, places] : rows) found.given.add_source(source, std::move(places));
  Addressed<Choice> out;
  for (auto& [source, choice] : all) {
    choice.coupling = setup.id;
    out.emplace_back(source, std::move(choice));
  }
  return out;
}

Addressed<Choice> PointSearch::fit_choices(CouplingId id, const MeshView& mesh,
                                           TargetFound& found) const {
  Addressed<Choice> out;
  for (auto& [source, vertices] : fits_->finish(mesh.owned(), found))
    out.emplace_back(source, Choice{id, {}, {}, std::move(vertices)});
  return out;
}

}  // namespace tess::m2m
