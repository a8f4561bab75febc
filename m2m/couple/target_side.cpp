#include "m2m/couple/target_side.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace tess::m2m {

std::vector<Aabb> TargetSide::start_search(const MeshView& mesh) {
  // Its tetrahedra are not looked at.
  validate(MeshView{mesh.points, {}, mesh.point_ids, {}, mesh.n_owned});
  const auto n_owned = static_cast<std::size_t>(mesh.n_owned);
  asked_.clear();
  nearest_.clear();
  to_ask_.clear();
  sources_.clear();
  rows_.clear();
  channels_.clear();
  tally_ = {};
  worst_ = {};
  best_.assign(n_owned, {});
  status_.assign(n_owned, Status::outside);
  distance_.assign(n_owned, 0);
  cover_ = cover_points(mesh.owned());
  return std::exchange(cover_.boxes, {});
}

void TargetSide::add(const collide::Hits& hits) {
  Asked& asked = asked_[hits.other];
  for (const collide::LocalPair& pair : hits.pairs) {
    asked.boxes.push_back(static_cast<std::uint32_t>(pair.mine));
    asked.source_boxes.push_back(static_cast<std::uint32_t>(pair.theirs));
  }
}

Addressed<DonorQuery> TargetSide::donor_queries(const MeshView& mesh) {
  Addressed<DonorQuery> out;
  for (auto& [source, asked] : asked_) {
    sort_unique_boxes(asked.boxes);
    sort_unique_boxes(asked.source_boxes);
    DonorQuery query{setup.id, {}, std::exchange(asked.source_boxes, {}), {}};
    for (const std::uint32_t box : asked.boxes)
      for (const std::uint32_t row : cover_.members_of(box)) {
        asked.rows.push_back(static_cast<std::int32_t>(row));
        query.points.push_back(mesh.points[row]);
      }
    asked.boxes = {};
    out.emplace_back(source, std::move(query));
  }
  n_open_ = out.size();
  cover_ = {};
  return out;
}

void TargetSide::add(const DonorAnswer& answer) {
  Asked& asked = asked_.at(answer.from);
  asked.held.reserve(answer.points.size());
  for (std::size_t i = 0; i < answer.points.size(); ++i) {
    const std::int32_t row = asked.rows[answer.points[i]];
    asked.held.push_back(row);
    Best& best = best_[static_cast<std::size_t>(row)];
    const Candidate& mine = answer.candidates[i];
    if (mine.tet == best.candidate.tet && mine.status != Status::outside)
      fail(ErrorCode::bad_mesh, "coupling ", static_cast<std::uint64_t>(setup.id),
           ": the source pieces ", collide::owner_text(best.source), " and ",
           collide::owner_text(answer.from), " have tetrahedra of the same id ", mine.tet,
           ": tet_ids are unique in the mesh");
    if (better(mine, best.candidate)) best = {mine, answer.from};
  }
  asked.rows = {};
  --n_open_;
}

bool TargetSide::needs_sources() {
  if (!nearest_.empty()) return false;  // they are named
  for (std::size_t v = 0; v < best_.size(); ++v)
    if (setup.kind == TransferKind::nearest || best_[v].candidate.status == Status::outside) {
      to_ask_.push_back(static_cast<std::uint32_t>(nearest_.size()));
      nearest_.push_back({.row = static_cast<std::int32_t>(v)});
    }
  return !nearest_.empty();
}

void TargetSide::name_sources(const MeshView& mesh, std::span<const SourcePiece> sources) {
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
  for (const NearestSoFar& point : nearest_)
    grow(around, mesh.points[static_cast<std::size_t>(point.row)]);
  nearest_parts_ = NearestParts(boxes, around);
}

Addressed<NearestQuery> TargetSide::nearest_queries(const MeshView& mesh) {
  std::map<collide::OwnerId, NearestQuery> queries;
  std::erase_if(to_ask_, [&](std::uint32_t key) {
    NearestSoFar& so_far = nearest_[key];
    const Point& point = mesh.points[static_cast<std::size_t>(so_far.row)];
    const NearestParts::RankedPart next = nearest_parts_.next(point, so_far.asked);
    if (next == NearestParts::none || next.squared_distance > so_far.squared_distance) return true;
    so_far.asked = next;
    NearestQuery& query = queries[sources_[static_cast<std::size_t>(next.number)]];
    query.coupling = setup.id;
    query.keys.push_back(key);
    query.points.push_back(point);
    query.squared_reaches.push_back(so_far.squared_distance);
    return false;
  });
  n_open_ = queries.size();
  return {std::make_move_iterator(queries.begin()), std::make_move_iterator(queries.end())};
}

void TargetSide::add(const NearestAnswer& answer) {
  for (std::size_t i = 0; i < answer.keys.size(); ++i) {
    NearestSoFar& mine = nearest_[answer.keys[i]];
    const double d = answer.squared_distances[i];
    if (answer.vertices[i] < 0 || d > mine.squared_distance ||
        (d == mine.squared_distance && answer.ids[i] >= mine.id))
      continue;
    mine.squared_distance = d;
    mine.id = answer.ids[i];
    mine.vertex = answer.vertices[i];
    mine.source = answer.from;
  }
  --n_open_;
}

Addressed<Choice> TargetSide::choices(const MeshView& mesh) {
  std::map<collide::OwnerId, Choice> all;
  for (auto& [source, asked] : asked_) {
    Choice& choice = all[source];
    if (setup.kind == TransferKind::nearest) continue;
    std::vector<std::int32_t> mine;
    for (std::size_t i = 0; i < asked.held.size(); ++i) {
      if (best_[static_cast<std::size_t>(asked.held[i])].source != source) continue;
      choice.answers.push_back(static_cast<std::uint32_t>(i));
      mine.push_back(asked.held[i]);
    }
    if (!mine.empty()) rows_[source] = std::move(mine);
  }
  for (std::size_t v = 0; v < best_.size(); ++v) {
    status_[v] = best_[v].candidate.status;
    distance_[v] = best_[v].candidate.distance;  // infinite if outside
    ++tally_.counts[static_cast<std::size_t>(status_[v])];
  }
  const bool takes_outside = std::holds_alternative<Nearest>(setup.policy);
  for (const NearestSoFar& nearest : nearest_) {
    const auto row = static_cast<std::size_t>(nearest.row);
    const bool is_outside = status_[row] == Status::outside;
    if (is_outside) distance_[row] = std::sqrt(nearest.squared_distance);
    if (is_outside && !takes_outside) continue;
    if (nearest.vertex < 0) {
      if (!source_has_points_) continue;
      fail(
          ErrorCode::bad_mesh,
          "no source piece owns a point that is a corner of its tetrahedra, so that no point has a "
          "nearest vertex: set MeshView::n_owned in the source, too");
    }
    all[nearest.source].vertices.push_back(nearest.vertex);
    rows_[nearest.source].push_back(nearest.row);
  }
  for (std::size_t v = 0; v < status_.size(); ++v)
    if (status_[v] >= Status::snapped)
      worst_.add({mesh.point_ids[v], mesh.points[v], distance_[v], status_[v]});
  asked_.clear();
  nearest_ = {};
  to_ask_ = {};
  best_ = {};
  nearest_parts_ = {};
  sources_ = {};
  Addressed<Choice> out;
  for (auto& [source, choice] : all) {
    choice.coupling = setup.id;
    out.emplace_back(source, std::move(choice));
  }
  return out;
}

void TargetSide::add(GivenValues rows) {
  Rounds<GivenValues>& channel = channels_[rows.take->channel];
  const std::uint32_t round = rows.round;
  channel.add(round, std::move(rows));
}

bool TargetSide::has_next(std::uint64_t channel) const {
  return channels_.at(channel).has_next(rows_.size());
}

void TargetSide::take_next(std::uint64_t channel, std::span<double> values) {
  for (const GivenValues& message : channels_.at(channel).take()) {
    const std::vector<std::int32_t>& rows = rows_.at(message.from);
    const std::size_t n_components = message.values.size() / rows.size();
    TESS_CHECK(values.size() == n_components * status_.size(), "the source gives ", n_components,
               " components per point, but the target takes ", values.size(), " values for its ",
               status_.size(), " points: take points × components");
    for (std::size_t i = 0; i < rows.size(); ++i)
      std::copy_n(message.values.data() + i * n_components, n_components,
                  values.data() + static_cast<std::size_t>(rows[i]) * n_components);
  }
  fill_outside(setup.policy, status_, values);
}

}  // namespace tess::m2m
