#include "m2m/couple/overlap_search.hpp"

#include "collide/hit_receivers.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tess::m2m {
namespace {

/// What is covered to a smaller fraction of its volume counts as not covered.
constexpr double no_coverage = 1e-12;
/// What is covered to a larger fraction is covered more than once; less is rounding.
constexpr double over_coverage = 1 + 1e-9;

}  // namespace

std::vector<Aabb> OverlapSearch::start(const MeshView& mesh) {
  validate(mesh);
  require_dimensions(TransferKind::conservative, 0, mesh.dimension, mesh.dimension);
  if (to_cells_) {
    numbers_.resize(mesh.own_tets().size());
    std::iota(numbers_.begin(), numbers_.end(), 0);
    for (const Tet& tet : mesh.own_tets()) volumes_.push_back(size_of(mesh, tet));
  } else {
    numbers_ = tets_at_owned(mesh);
    volumes_.assign(mesh.points.size(), 0);
    for (const std::int32_t number : numbers_) {
      const Tet& tet = mesh.tets[static_cast<std::size_t>(number)];
      for (const VertexId v : tet) volumes_[static_cast<std::size_t>(v)] += size_of(mesh, tet);
    }
  }
  covered_.assign(numbers_.size(), {});
  std::vector<Tet> tets;
  for (const std::int32_t t : numbers_) tets.push_back(mesh.tets[static_cast<std::size_t>(t)]);
  cover_ = cover_tets(mesh.points, tets);
  return std::exchange(cover_.boxes, {});
}

std::vector<PointReport> OverlapSearch::point_reports(const MeshView& mesh,
                                                      collide::OwnerId me) const {
  std::vector<PointReport> reports(mesh.points.size());
  for (std::size_t v = 0; v < reports.size(); ++v) {
    const bool is_owned = static_cast<std::int64_t>(v) < mesh.n_owned;
    reports[v] = {mesh.point_ids[v], me,         static_cast<std::int32_t>(v), 0,
                  is_owned ? 0 : -1, volumes_[v]};
  }
  const std::size_t n_own = mesh.own_tets().size();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (const VertexId corner : mesh.tets[t]) {
      PointReport& report = reports[static_cast<std::size_t>(corner)];
      if (report.n_tets >= 0) ++report.n_tets;
      if (t < n_own) ++report.n_own_tets;
    }
  return reports;
}

void OverlapSearch::add(const collide::Hits& hits) {
  Asked& asked = asked_[hits.other];
  for (const collide::LocalPair& pair : hits.pairs)
    asked.boxes.emplace_back(static_cast<std::uint32_t>(pair.mine),
                             static_cast<std::uint32_t>(pair.theirs));
}

SearchStep OverlapSearch::next(const CouplingSetup& setup, const MeshView& mesh,
                               TargetFound& found) {
  SearchStep step;
  if (stage_ == Stage::ask) {
    stage_ = Stage::choose;
    step.queries = queries(setup, mesh);
    if (!step.queries.empty()) return step;
  }
  if (stage_ == Stage::choose) {
    stage_ = Stage::finish;
    for (auto& [source, kept] : found.given.keep_rows())
      step.choices.emplace_back(source, Choice{setup.id, {}, std::move(kept), {}});
    if (!step.choices.empty()) return step;
  }
  finish(mesh, found);
  step.then = SearchStep::Then::nothing;
  return step;
}

std::array<std::uint32_t, 4> OverlapSearch::places_of(const MeshView& mesh,
                                                      std::uint32_t tet) const {
  std::array<std::uint32_t, 4> places;
  if (to_cells_) {
    places.fill(tet);
  } else {
    const Tet& corners = mesh.tets[static_cast<std::size_t>(numbers_[tet])];
    for (std::size_t c = 0; c < 4; ++c) places[c] = static_cast<std::uint32_t>(corners[c]);
  }
  return places;
}

Addressed<SearchQuery> OverlapSearch::queries(const CouplingSetup& setup, const MeshView& mesh) {
  const std::size_t n_places = to_cells_ ? numbers_.size() : static_cast<std::size_t>(mesh.n_owned);
  Addressed<SearchQuery> out;
  std::vector<std::int32_t> unknown_of(volumes_.size(), -1);
  for (auto& [source, asked] : asked_) {
    sort_unique(asked.boxes);
    TargetTets to;
    to.dimension = mesh.dimension;
    to.tolerance = setup.tolerance;
    to.facing = setup.facing;
    for (auto pair = asked.boxes.begin(); pair != asked.boxes.end();) {
      const std::uint32_t box = pair->first;
      for (const std::uint32_t member : cover_.members_of(box)) {
        asked.tets.push_back(member);
        to.tets.push_back(
            corners_of(mesh.points, mesh.tets[static_cast<std::size_t>(numbers_[member])]));
      }
      to.first.push_back(static_cast<std::uint32_t>(to.tets.size()));
      for (; pair != asked.boxes.end() && pair->first == box; ++pair)
        to.near.push_back(pair->second);
      to.first_near.push_back(static_cast<std::uint32_t>(to.near.size()));
    }
    asked.boxes = {};
    // Places first, then ghosts.
    std::vector<std::uint32_t> numbered;
    for (const bool ghosts : {false, true}) {
      for (const std::uint32_t tet : asked.tets)
        for (const std::uint32_t place : places_of(mesh, tet)) {
          if ((place >= n_places) != ghosts || unknown_of[place] >= 0) continue;
          unknown_of[place] = static_cast<std::int32_t>(numbered.size());
          numbered.push_back(place);
        }
      if (!ghosts) asked.places = numbered;
    }
    to.n_rows = static_cast<std::uint32_t>(asked.places.size());
    for (const std::uint32_t place : numbered) to.quanta.push_back(quantum_of(volumes_[place]));
    for (const std::uint32_t tet : asked.tets) {
      std::array<std::uint32_t, 4> unknowns = places_of(mesh, tet);
      for (std::uint32_t& u : unknowns) u = static_cast<std::uint32_t>(unknown_of[u]);
      to.unknowns.push_back(unknowns);
    }
    for (const std::uint32_t place : numbered) unknown_of[place] = -1;
    out.emplace_back(source, SearchQuery{setup.id, {}, std::move(to)});
  }
  cover_ = {};
  return out;
}

void OverlapSearch::add(collide::OwnerId from, const OverlapAnswer& answer, TargetFound& found) {
  Asked& asked = asked_.at(from);
  for (std::size_t k = 0; k < answer.tets.size(); ++k)
    for (std::size_t a = 0; a < 4; ++a)
      covered_[asked.tets[answer.tets[k]]][a] += answer.covered[k][a];  // exact in any order
  std::vector<std::uint32_t> places;
  for (const std::uint32_t row : answer.rows) places.push_back(asked.places[row]);
  if (!places.empty()) found.given.add_source(from, std::move(places));
  asked_.erase(from);
}

std::vector<double> OverlapSearch::covered_fractions(const MeshView& mesh,
                                                     TargetFound& found) const {
  if (!to_cells_) {
    found.mass = MassMatrix(mesh, numbers_, covered_);
    return {found.mass.covered_fractions().begin(), found.mass.covered_fractions().end()};
  }
  std::vector<double> fractions;
  for (std::size_t t = 0; t < numbers_.size(); ++t) {
    const std::array<double, 4>& c = covered_[t];
    found.covered_volumes.push_back((c[0] + c[1]) + (c[2] + c[3]));
    fractions.push_back(volumes_[t] > 0 ? found.covered_volumes[t] / volumes_[t] : 0);
  }
  return fractions;
}

void OverlapSearch::finish(const MeshView& mesh, TargetFound& found) {
  found.given.join(std::move(partial_));
  for (const double fraction : covered_fractions(mesh, found)) {
    found.status.push_back(!(fraction > no_coverage)     ? Status::outside
                           : fraction >= 1 - no_coverage ? Status::inside
                                                         : Status::snapped);
    ++found.tally.counts[static_cast<std::size_t>(found.status.back())];
    if (fraction > over_coverage) {
      ++found.tally.n_overcovered;
      found.tally.most_covered = std::max(found.tally.most_covered, fraction);
    }
  }
}

}  // namespace tess::m2m
