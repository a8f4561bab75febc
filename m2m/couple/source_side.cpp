#include "m2m/couple/source_side.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <utility>

namespace tess::m2m {

std::vector<Aabb> SourceSide::start_search(const MeshView& mesh) {
  validate(mesh);
  require_dimensions(setup.kind, setup.tolerance, mesh.dimension, mesh.dimension);
  if (setup.kind == TransferKind::native && mesh.lacks_elements)
    fail(
        ErrorCode::bad_argument,
        "kind native needs the elements that the tetrahedra of a source piece were split from: cut "
        "the mesh with 1 halo layer, source_halo_layers(), and place() it with elements");
  queries_.clear();
  given_.clear();
  attached_.clear();
  rounds_.clear();
  has_fits_ = false;
  n_rows_ = n_unknowns(mesh, setup.source_values);
  stays_ = same_.ask(mesh);
  if (stays_ == SameMesh::Answer::same) return cover_.boxes;
  nearest_.reset();
  gradient_vertices_.clear();
  gradient_rows_ = {};
  nearest_cells_.reset();
  // The cells of a wall hold hardly any point, so all points ask for the nearest.
  const bool holds_points =
      setup.collides() && (mesh.dimension == 3 || !setup.seeks_nearest_cells());
  cover_ = holds_points ? cover_tets(mesh.points, mesh.own_tets(), setup.tolerance) : Cover{};
  return cover_.boxes;
}

bool SourceSide::add(SearchQuery query) {
  queries_.push_back(std::move(query));
  return queries_.size() == 1;
}

std::vector<BestDonors> SourceSide::locate(const MeshView& mesh,
                                           std::span<const SearchQuery> queries,
                                           std::uint64_t& n_tested) {
  std::vector<BestDonors> located;
  std::vector<std::uint32_t> boxes;
  std::vector<std::span<const Point>> lists;
  std::vector<std::size_t> at;  // of each list, in located
  for (const SearchQuery& query : queries) {
    const auto* of_points = std::get_if<DonorQuery>(&query.what);
    if (of_points == nullptr) continue;
    const auto& [of_boxes, points, reaches] = *of_points;
    if (mesh.dimension == 3 && reaches.empty()) {
      boxes.insert(boxes.end(), of_boxes.begin(), of_boxes.end());
      lists.emplace_back(points);
      at.push_back(located.size());
      located.emplace_back();
      continue;
    }
    if (!nearest_cells_) nearest_cells_.emplace(mesh);
    located.push_back(reaches.empty()
                          ? nearest_cells_->snapped(mesh, points, setup.tolerance, n_tested)
                          : nearest_cells_->within(mesh, points, reaches, n_tested));
  }
  if (lists.empty()) return located;
  sort_unique_boxes(boxes);
  std::vector<BestDonors> in_cells =
      best_donors(mesh, cover_, boxes, lists, setup.tolerance, n_tested);
  for (std::size_t k = 0; k < at.size(); ++k) located[at[k]] = std::move(in_cells[k]);
  return located;
}

Addressed<SearchAnswer> SourceSide::answers(const MeshView& mesh, std::uint64_t& n_tested) {
  std::vector<SearchQuery> queries = std::exchange(queries_, {});
  std::vector<BestDonors> located = locate(mesh, queries, n_tested);
  Addressed<SearchAnswer> out;
  auto next = located.begin();
  for (SearchQuery& query : queries) {
    out.emplace_back(query.from, SearchAnswer{setup.id, {}, {}});
    auto& what = out.back().second.what;
    if (const auto* tets = std::get_if<TargetTets>(&query.what))
      what = answer_overlaps(mesh, query.from, *tets, n_tested);
    else if (const auto* of_nearest = std::get_if<NearestQuery>(&query.what))
      what = answer_nearest(mesh, *of_nearest);
    else
      what = answer_points(query, std::move(*next++));
  }
  return out;
}

Addressed<SearchAnswer> SourceSide::choose(const MeshView& mesh, Choice choice,
                                           std::uint64_t& n_linear) {
  Addressed<SearchAnswer> out;
  if (choice.is_alone)
    attached_.push_back(choice.from);
  else if (setup.is_conservative())
    out.emplace_back(choice.from, SearchAnswer{setup.id, {}, choose_rows(mesh, choice)});
  else if (setup.applies_at_target())
    given_[choice.from].sent = std::move(choice.vertices);
  else
    choose_donors(mesh, choice, n_linear);
  return out;
}

void SourceSide::check_rows(const MeshView& mesh) const {
  const std::size_t n = n_unknowns(mesh, setup.source_values);
  TESS_CHECK(n == n_rows_, "a piece has ", n, " rows of values, and had ", n_rows_,
             " in the last search of the coupling: search again when points or tetrahedra change");
}

void SourceSide::give(const MeshView& mesh, std::span<const double> values, detail::Taker take,
                      const std::function<void(collide::OwnerId, GivenValues)>& send) {
  const std::size_t n_rows = n_unknowns(mesh, setup.source_values);
  TESS_CHECK(n_rows == 0 || (!values.empty() && values.size() % n_rows == 0), "a piece with ",
             n_rows, " ", rows_of(setup.source_values), " gives ", values.size(),
             " values: give as many rows, ghosts included");
  check_rows(mesh);
  if (n_rows == 0) return;
  prepare(mesh);
  const std::size_t n_components = values.size() / n_rows;
  const std::vector<Point> slopes = gradients(values, n_components);
  const std::uint32_t round = rounds_[take->channel]++;
  for (const auto& [target, given] : given_)
    send(target, GivenValues{setup.id,
                             {},
                             take,
                             round,
                             setup.applies_at_target()
                                 ? loads(given, values, n_components)
                                 : interpolate(mesh, given, values, slopes, n_components)});
}

Addressed<Rows<double>> SourceSide::donor_rows(const MeshView& mesh) {
  check_rows(mesh);
  prepare(mesh);
  Addressed<Rows<double>> out;
  for (const auto& [target, given] : given_) out.emplace_back(target, weights_of(mesh, given));
  return out;
}

}  // namespace tess::m2m
