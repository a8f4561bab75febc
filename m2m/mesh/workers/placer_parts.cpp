#include "m2m/mesh/workers/placer.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tess::m2m {

void Placer::finish_if_complete() {
  if (finished_ && !has_halo() && n_answers_due_ == 0 && n_unused_due_ == 0) finish();
}

void Placer::finish() {
  drop(points_);
  std::vector<Formula> formulas;
  for (const FormulaField& field : setup_.fields)
    formulas.push_back(make_formula(field.name, field.domain));
  for (std::size_t k = 0; k < parts_.size(); ++k)
    build(first_part_ + static_cast<std::int32_t>(k), formulas, report_.error);
  sort_unique(ghost_uses_);
  is_built_ = true;
  contribute(JoinReports{}, std::move(report_), std::exchange(finished_, {}));
  load_if_complete();
}

void Placer::build(std::int32_t k, const std::vector<Formula>& formulas, FirstError& error) {
  Draft& part = this->part(k);
  MeshPart& mesh = part.mesh;
  mesh.lacks_elements = setup_.lacks_elements;
  drop(part.asked);
  if (has_halo()) {
    for (const auto& [id, tet] : part.halo) {
      mesh.tet_ids.push_back(id);
      mesh.tets.push_back(tet);
    }
    drop(part.halo);
    number_corners(mesh.tets, IdSet(mesh.tets));
    std::sort(part.points.begin(), part.points.end(), by_id);
  }
  std::sort(part.unused.begin(), part.unused.end(), by_id);

  // The points are in the order of their ids, and the corners of tetrahedra are positions in it.
  std::vector<VertexId> local(part.points.size());
  mesh.points.reserve(part.points.size() + part.unused.size());
  mesh.point_ids.reserve(part.points.size() + part.unused.size());
  const auto add = [&](const PartPoint& point) {
    mesh.points.push_back(point.at);
    mesh.point_ids.push_back(point.id);
    return static_cast<VertexId>(mesh.points.size()) - 1;
  };
  auto unused = part.unused.begin();
  for (std::size_t v = 0; v < part.points.size(); ++v) {
    const PartPoint& point = part.points[v];
    if (point.owner != k) continue;
    for (; unused != part.unused.end() && unused->id < point.id; ++unused) add(*unused);
    local[v] = add(point);
  }
  for (; unused != part.unused.end(); ++unused) add(*unused);
  mesh.n_owned = static_cast<std::int64_t>(mesh.points.size());
  std::vector<GhostList> ghosts;  // there are few owners
  for (std::size_t v = 0, list = 0; v < part.points.size(); ++v) {
    const PartPoint& point = part.points[v];
    if (point.owner == k) continue;
    local[v] = add(point);
    if (list == ghosts.size() || ghosts[list].owner != point.owner)
      for (list = 0; list < ghosts.size() && ghosts[list].owner != point.owner;) ++list;
    if (list == ghosts.size()) ghosts.push_back({point.owner, k, {}, {}});
    ghosts[list].ids.push_back(point.id);
    ghosts[list].there.push_back(local[v]);
  }
  drop(part.points);
  drop(part.unused);
  for (Tet& tet : mesh.tets)
    for (VertexId& v : tet) v = local[static_cast<std::size_t>(v)];

  for (GhostList& list : ghosts) {
    const PeId to = home_of(list.owner);
    group()[to].send<&Placer::receive_ghosts>(std::move(list));
  }

  evaluate(part, formulas, error);
}

void Placer::evaluate(Draft& part, const std::vector<Formula>& formulas, FirstError& error) const {
  const MeshPart& mesh = part.mesh;
  const std::size_t n_fields = formulas.size();
  part.rows.resize(mesh.points.size() * n_fields);
  for (std::size_t f = 0; f < n_fields; ++f) {
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      double& value = part.rows[v * n_fields + f];
      value = formulas[f](mesh.points[v]);
      if (std::isfinite(value)) continue;
      const auto key = static_cast<std::int64_t>(f) * setup_.n_points + mesh.point_ids[v];
      if (error.key >= 0 && error.key <= key) continue;
      error = {key, static_cast<std::int32_t>(ErrorCode::bad_value),
               not_finite_text(setup_.fields[f].name, value, mesh.point_ids[v], setup_.shown_name,
                               mesh.points[v])};
    }
  }
}

void Placer::receive_ghosts(GhostList list) {
  ghosts_.push_back(std::move(list));
  load_if_complete();
}

void Placer::load_if_complete() {
  if (is_built_ && !has_halo() && ghosts_.size() == ghost_uses_.size()) load_workers();
}

void Placer::load_workers() {
  std::sort(ghosts_.begin(), ghosts_.end(), [](const GhostList& a, const GhostList& b) {
    return std::pair(a.owner, a.user) < std::pair(b.owner, b.user);
  });
  for (GhostList& list : ghosts_) {
    MeshPart& mesh = part(list.owner).mesh;
    const auto end = mesh.point_ids.begin() + mesh.n_owned;
    Ghosts ghosts{list.user, {}, std::move(list.there)};
    auto at = mesh.point_ids.begin();
    for (const VertexId v : list.ids) {
      at = std::lower_bound(at, end, v);
      ghosts.here.push_back(static_cast<std::int32_t>(at - mesh.point_ids.begin()));
    }
    mesh.ghosts.push_back(std::move(ghosts));
  }
  drop(ghosts_);
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Draft& part = parts_[k];
    setup_.workers[{first_part_ + static_cast<std::int32_t>(k)}].send<&Worker::load>(
        PartLoad{std::move(part.mesh), setup_.fields.size(), std::move(part.rows)});
  }
  drop(parts_);
}

}  // namespace tess::m2m
