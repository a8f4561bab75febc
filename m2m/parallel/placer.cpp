#include "m2m/parallel/placer.hpp"

#include "m2m/io/ranges/mesh_ranges.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tess::m2m {
namespace {

constexpr std::int32_t no_owner = std::numeric_limits<std::int32_t>::max();

/// Frees the memory of a list.
template <class List>
void drop(List& list) {
  List().swap(list);
}

}  // namespace

Placer::Placer(const PlacerSetup& setup)
    : setup_(setup), n_pes_(tess::n_pes()), me_(tess::my_pe().value) {
  first_point_ = first_of(setup.n_points, me_);
  first_tet_ = first_of(setup.n_tets, me_);
  const auto first_part = [&](std::int32_t pe) {
    return static_cast<std::int32_t>((std::int64_t{pe} * setup.n_parts + n_pes_ - 1) / n_pes_);
  };
  first_part_ = first_part(me_);
  parts_.resize(static_cast<std::size_t>(first_part(me_ + 1) - first_part_));
}

PeId Placer::home_of(std::int32_t part) const {
  return PeId{static_cast<std::int32_t>(std::int64_t{part} * n_pes_ / setup_.n_parts)};
}

template <class Visit>
void Placer::for_each_keeper(std::span<const VertexId> ids, const Visit& visit) const {
  while (!ids.empty()) {
    const GlobalId v = ids.front();
    const auto keeper = static_cast<std::int32_t>(((v + 1) * n_pes_ - 1) / setup_.n_points);
    const GlobalId end = first_of(setup_.n_points, keeper + 1);
    const auto n =
        static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), end) - ids.begin());
    visit(keeper, ids.first(n));
    ids = ids.subspan(n);
  }
}

void Placer::receive_range(RangeLoad load) {
  points_ = std::move(load.points);
  tets_ = std::move(load.tets);
}

void Placer::read(Callback<PlacerReport> target) {
  PlacerReport report;
  const GlobalId n_points = first_of(setup_.n_points, me_ + 1) - first_point_;
  const GlobalId n_tets = first_of(setup_.n_tets, me_ + 1) - first_tet_;
  try {
    if (!setup_.name.empty()) {
      const std::unique_ptr<MeshRanges> file = open_ranges(setup_.name);
      if (file == nullptr || file->n_points != setup_.n_points || file->n_tets != setup_.n_tets)
        fail(ErrorCode::bad_file, setup_.name, ": differs between the processes on ", tess::my_pe(),
             "; give a file that all processes see");
      points_.resize(static_cast<std::size_t>(n_points));
      file->points(first_point_, points_);
      tets_.resize(static_cast<std::size_t>(n_tets));
      file->tets(first_tet_, tets_);
    }
    report.findings.add_points(first_point_, points_);
    report.findings.add_corners(first_tet_, tets_, setup_.n_points);
  } catch (const Error& error) {
    report.error = {me_, static_cast<std::int32_t>(error.code()), error.what()};
  }
  // A refused mesh ends here: its queries need no answer.
  const bool refused = report.error.key >= 0 || report.findings.bad_corner.tet >= 0;
  reading_ = refused ? Reading::refused : Reading::done;
  if (!refused) ask_corners();
  for (CornerQuery& query : early_queries_) answer_corners(std::move(query));
  drop(early_queries_);
  contribute(JoinReports{}, std::move(report), std::move(target));
}

void Placer::ask_corners() {
  const auto begin = static_cast<VertexId>(first_point_);
  const auto end = static_cast<VertexId>(first_point_ + static_cast<GlobalId>(points_.size()));
  VertexId least = end, greatest = begin - 1;
  for (const Tet& tet : tets_)
    for (const VertexId v : tet) {
      least = std::min(least, v);
      greatest = std::max(greatest, v);
    }
  if (least >= begin && greatest < end) return;
  far_.emplace(least, greatest);
  for (const Tet& tet : tets_)
    for (const VertexId v : tet)
      if (v < begin || v >= end) far_->add(v);
  far_->number();
  const std::vector<VertexId> ids = far_->list();
  far_points_.resize(ids.size());
  for_each_keeper(ids, [&](std::int32_t keeper, std::span<const VertexId> of) {
    group()[PeId{keeper}].send<&Placer::answer_corners>(
        CornerQuery{tess::my_pe(), {of.begin(), of.end()}});
    ++n_corners_due_;
  });
}

void Placer::answer_corners(CornerQuery query) {
  if (reading_ == Reading::before) {
    early_queries_.push_back(std::move(query));
    return;
  }
  if (reading_ == Reading::refused) return;
  CornerAnswer answer{query.ids.front(), {}};
  answer.points.reserve(query.ids.size());
  for (const VertexId v : query.ids)
    answer.points.push_back(points_[static_cast<std::size_t>(v - first_point_)]);
  group()[query.from].send<&Placer::receive_corners>(std::move(answer));
}

void Placer::receive_corners(const CornerAnswer& answer) {
  std::copy(answer.points.begin(), answer.points.end(),
            far_points_.begin() + far_->rank(answer.first));
  --n_corners_due_;
  measure_if_complete();
}

std::array<Point, 4> Placer::corners_of(const Tet& tet) const {
  std::array<Point, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) {
    const GlobalId at = tet[k] - first_point_;
    corners[k] = at >= 0 && at < static_cast<GlobalId>(points_.size())
                     ? points_[static_cast<std::size_t>(at)]
                     : far_points_[static_cast<std::size_t>(far_->rank(tet[k]))];
  }
  return corners;
}

void Placer::measure(const Aabb& bounds, Callback<Measured> target) {
  measures_ = bounds;
  measured_ = std::move(target);
  measure_if_complete();
}

void Placer::measure_if_complete() {
  if (!measures_ || n_corners_due_ != 0) return;
  Measured measured;
  const HilbertCube cube(*measures_);
  measures_.reset();
  cells_.resize(tets_.size());
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    const std::array<Point, 4> corners = corners_of(tets_[t]);
    measured.report.findings.add_shape(first_tet_ + static_cast<GlobalId>(t), corners);
    cells_[t] = cube.cell(mean_of_corners(corners));
  }
  far_.reset();
  drop(far_points_);
  measured.counts =
      CurveCut(static_cast<std::uint64_t>(setup_.n_tets), setup_.n_parts).counts(cells_);
  contribute(JoinMeasured{}, std::move(measured), std::move(measured_));
}

void Placer::count(const CurveCut& cut, Callback<CellCounts> target) {
  contribute(JoinCounts{}, cut.counts(cells_), std::move(target));
}

void Placer::send_tets(const CurveCut& cut) {
  const std::vector<std::int32_t> parts = cut.parts(cells_);
  drop(cells_);
  std::vector<std::uint32_t> begin(static_cast<std::size_t>(setup_.n_parts) + 1);
  for (const std::int32_t part : parts) ++begin[static_cast<std::size_t>(part) + 1];
  std::vector<TetBatch> batches;  // in the order of the parts
  for (std::int32_t k = 0; k < setup_.n_parts; ++k) {
    const std::uint32_t n = begin[static_cast<std::size_t>(k) + 1];
    begin[static_cast<std::size_t>(k) + 1] += begin[static_cast<std::size_t>(k)];
    if (n == 0) continue;
    const PeId to = home_of(k);
    if (batches.empty() || batches.back().to != to) batches.push_back({tess::my_pe(), to});
    batches.back().parts.push_back(k);
    batches.back().sizes.push_back(static_cast<std::int32_t>(n));
  }
  std::vector<std::int32_t> order(tets_.size());
  for (std::size_t t = 0; t < parts.size(); ++t)
    order[begin[static_cast<std::size_t>(parts[t])]++] = static_cast<std::int32_t>(t);
  auto next = order.begin();
  for (TetBatch& batch : batches) {
    std::int64_t n = 0;
    for (const std::int32_t size : batch.sizes) n += size;
    batch.ids.reserve(static_cast<std::size_t>(n));
    batch.tets.reserve(static_cast<std::size_t>(n));
    for (const auto end = next + n; next != end; ++next) {
      batch.ids.push_back(static_cast<std::int32_t>(first_tet_ + *next));
      batch.tets.push_back(tets_[static_cast<std::size_t>(*next)]);
    }
    group()[batch.to].send<&Placer::receive_tets>(std::move(batch));
  }
  drop(tets_);
}

void Placer::receive_tets(TetBatch batch) {
  batches_.push_back(std::move(batch));
}

template <auto Handler>
void Placer::send_queries() {
  std::vector<PointQuery> queries = queries_of_parts();
  n_points_due_ = queries.size();
  for (PointQuery& query : queries) group()[query.to].send<Handler>(std::move(query));
}

void Placer::ask_points() {
  // The ranges are in the order of the PEs, so the tetrahedra of a part are in ascending order.
  std::sort(batches_.begin(), batches_.end(),
            [](const TetBatch& a, const TetBatch& b) { return a.from < b.from; });
  std::vector<std::size_t> sizes(parts_.size());
  for (const TetBatch& batch : batches_)
    for (std::size_t run = 0; run < batch.parts.size(); ++run)
      sizes[static_cast<std::size_t>(batch.parts[run] - first_part_)] +=
          static_cast<std::size_t>(batch.sizes[run]);
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    parts_[k].mesh.tets.reserve(sizes[k]);
    parts_[k].mesh.tet_ids.reserve(sizes[k]);
  }
  for (TetBatch& batch : batches_) {
    std::ptrdiff_t at = 0;
    for (std::size_t run = 0; run < batch.parts.size(); ++run) {
      MeshPart& mesh = part(batch.parts[run]).mesh;
      const std::ptrdiff_t end = at + batch.sizes[run];
      mesh.tets.insert(mesh.tets.end(), batch.tets.begin() + at, batch.tets.begin() + end);
      mesh.tet_ids.insert(mesh.tet_ids.end(), batch.ids.begin() + at, batch.ids.begin() + end);
      at = end;
    }
    batch = {};
  }
  drop(batches_);
  for (Part& part : parts_) {
    part.mesh.n_own_tets = static_cast<std::int64_t>(part.mesh.tets.size());
    part.asked = IdSet(part.mesh.tets).list();
  }
  send_queries<&Placer::receive_point_query>();
}

std::vector<PointQuery> Placer::queries_of_parts() const {
  std::vector<PointQuery> queries;
  std::vector<std::int32_t> query_of(static_cast<std::size_t>(n_pes_), -1);
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    for_each_keeper(parts_[k].asked, [&](std::int32_t keeper, std::span<const VertexId> ids) {
      std::int32_t& at = query_of[static_cast<std::size_t>(keeper)];
      if (at < 0) {
        at = static_cast<std::int32_t>(queries.size());
        queries.push_back({tess::my_pe(), PeId{keeper}});
      }
      PointQuery& query = queries[static_cast<std::size_t>(at)];
      query.parts.push_back(first_part_ + static_cast<std::int32_t>(k));
      query.sizes.push_back(static_cast<std::int32_t>(ids.size()));
      query.ids.insert(query.ids.end(), ids.begin(), ids.end());
    });
  }
  return queries;
}

void Placer::receive_point_query(PointQuery query) {
  queries_.push_back(std::move(query));
}

void Placer::answer_points(Callback<PlacerReport> target) {
  const std::size_t n = points_.size();
  owners_.assign(n, no_owner);
  users_begin_.assign(n + 1, 0);
  const auto for_each_use = [this](const auto& visit) {
    for (const PointQuery& query : queries_) {
      std::size_t at = 0;
      for (std::size_t run = 0; run < query.parts.size(); ++run)
        for (std::int32_t i = 0; i < query.sizes[run]; ++i, ++at)
          visit(static_cast<std::size_t>(query.ids[at] - first_point_), query.parts[run]);
    }
  };
  for_each_use([this](std::size_t v, std::int32_t part) {
    owners_[v] = std::min(owners_[v], part);
    ++users_begin_[v + 1];
  });
  if (setup_.halo_layers > 0) {
    for (std::size_t v = 0; v < n; ++v) users_begin_[v + 1] += users_begin_[v];
    users_.resize(users_begin_.back());
    std::vector<std::uint32_t> next(users_begin_.begin(), users_begin_.end() - 1);
    for_each_use([&](std::size_t v, std::int32_t part) { users_[next[v]++] = part; });
  }
  PlacerReport report;
  std::vector<UnusedPoints> unused;
  for (std::size_t v = 0; v < n; ++v) {
    if (owners_[v] != no_owner) continue;
    ++report.n_unused;
    const GlobalId id = first_point_ + static_cast<GlobalId>(v);
    owners_[v] = static_cast<std::int32_t>(id * setup_.n_parts / setup_.n_points);
    if (unused.empty() || unused.back().part != owners_[v]) unused.push_back({owners_[v], {}, {}});
    unused.back().ids.push_back(static_cast<VertexId>(id));
    unused.back().points.push_back(points_[v]);
  }
  for (UnusedPoints& points : unused) {
    const PeId to = home_of(points.part);
    group()[to].send<&Placer::receive_unused>(std::move(points));
  }
  for (PointQuery& query : queries_) {
    group()[query.from].send<&Placer::receive_points>(answer(query));
    query = {};
  }
  drop(queries_);
  if (setup_.halo_layers == 0) drop(points_);
  contribute(JoinReports{}, std::move(report), std::move(target));
}

PointAnswer Placer::answer(const PointQuery& query) const {
  PointAnswer answer;
  answer.parts = query.parts;
  answer.sizes = query.sizes;
  answer.points.reserve(query.ids.size());
  answer.owners.reserve(query.ids.size());
  for (const VertexId v : query.ids) {
    const auto at = static_cast<std::size_t>(v - first_point_);
    answer.points.push_back(points_[at]);
    answer.owners.push_back(owners_[at]);
    if (setup_.halo_layers == 0) continue;
    answer.n_users.push_back(static_cast<std::int32_t>(users_begin_[at + 1] - users_begin_[at]));
    answer.users.insert(answer.users.end(), users_.begin() + users_begin_[at],
                        users_.begin() + users_begin_[at + 1]);
  }
  answer.firsts.reserve(query.parts.size());
  std::size_t at = 0;
  for (const std::int32_t size : query.sizes) {
    answer.firsts.push_back(query.ids[at]);
    at += static_cast<std::size_t>(size);
  }
  return answer;
}

void Placer::receive_points(const PointAnswer& answer) {
  std::size_t at = 0;
  std::size_t user = 0;
  for (std::size_t run = 0; run < answer.parts.size(); ++run) {
    const std::int32_t k = answer.parts[run];
    Part& to = part(k);
    auto id = std::lower_bound(to.asked.begin(), to.asked.end(), answer.firsts[run]);
    for (std::int32_t i = 0; i < answer.sizes[run]; ++i, ++at, ++id) {
      to.points.push_back({*id, answer.owners[at], answer.points[at]});
      if (setup_.halo_layers == 0) continue;
      for (const auto end = user + static_cast<std::size_t>(answer.n_users[at]); user < end; ++user)
        if (answer.users[user] != k) to.others.push_back({answer.users[user], *id});
    }
  }
  --n_points_due_;
  finish_if_complete();
}

void Placer::receive_unused(const UnusedPoints& unused) {
  for (std::size_t i = 0; i < unused.ids.size(); ++i)
    part(unused.part).points.push_back({unused.ids[i], unused.part, unused.points[i]});
}

void Placer::ask_around() {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Part& part = parts_[k];
    std::sort(part.others.begin(), part.others.end());
    const auto asker = first_part_ + static_cast<std::int32_t>(k);
    for (auto at = part.others.begin(); at != part.others.end();) {
      AroundQuery query{asker, at->part, {}};
      for (; at != part.others.end() && at->part == query.part; ++at)
        query.vertices.push_back(at->vertex);
      const PeId to = home_of(query.part);
      group()[to].send<&Placer::answer_around>(std::move(query));
    }
    drop(part.others);
  }
}

void Placer::index_tets(Part& part) {
  const std::vector<Tet>& tets = part.mesh.tets;
  part.own_vertices.emplace(tets);
  part.begin.assign(static_cast<std::size_t>(part.own_vertices->size()) + 1, 0);
  for (const Tet& tet : tets)
    for (const VertexId v : tet)
      ++part.begin[static_cast<std::size_t>(part.own_vertices->rank(v)) + 1];
  for (std::size_t i = 1; i < part.begin.size(); ++i) part.begin[i] += part.begin[i - 1];
  part.around.resize(part.begin.back());
  std::vector<std::uint32_t> next(part.begin.begin(), part.begin.end() - 1);
  for (std::size_t t = 0; t < tets.size(); ++t)
    for (const VertexId v : tets[t])
      part.around[next[static_cast<std::size_t>(part.own_vertices->rank(v))]++] =
          static_cast<std::int32_t>(t);
}

void Placer::answer_around(const AroundQuery& query) {
  Part& asked = part(query.part);
  if (!asked.own_vertices) index_tets(asked);
  std::vector<std::int32_t> found;
  for (const VertexId v : query.vertices) {
    const auto at = static_cast<std::size_t>(asked.own_vertices->rank(v));
    found.insert(found.end(), asked.around.begin() + asked.begin[at],
                 asked.around.begin() + asked.begin[at + 1]);
  }
  sort_unique(found);
  AroundAnswer answer{query.asker, {}, {}};
  for (const std::int32_t t : found) {
    answer.ids.push_back(
        static_cast<std::int32_t>(asked.mesh.tet_ids[static_cast<std::size_t>(t)]));
    answer.tets.push_back(asked.mesh.tets[static_cast<std::size_t>(t)]);
  }
  const PeId to = home_of(query.asker);
  group()[to].send<&Placer::receive_around>(std::move(answer));
}

void Placer::receive_around(const AroundAnswer& answer) {
  Part& to = part(answer.asker);
  for (std::size_t i = 0; i < answer.ids.size(); ++i)
    to.halo.push_back({answer.ids[i], answer.tets[i]});
}

void Placer::ask_halo_points() {
  for (Part& part : parts_) {
    sort_unique(part.halo);
    std::vector<VertexId> known;
    for (const PartPoint& point : part.points) known.push_back(point.id);
    std::sort(known.begin(), known.end());
    std::vector<VertexId> corners;
    for (const auto& [id, tet] : part.halo) corners.insert(corners.end(), tet.begin(), tet.end());
    sort_unique(corners);
    part.asked.clear();
    std::set_difference(corners.begin(), corners.end(), known.begin(), known.end(),
                        std::back_inserter(part.asked));
  }
  send_queries<&Placer::answer_halo_points>();
}

void Placer::answer_halo_points(const PointQuery& query) {
  group()[query.from].send<&Placer::receive_points>(answer(query));
}

void Placer::finish(Callback<PlacerReport> target) {
  finished_ = std::move(target);
  finish_if_complete();
}

void Placer::finish_if_complete() {
  if (!finished_ || n_points_due_ != 0) return;
  drop(points_);
  PlacerReport report;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    build(first_part_ + static_cast<std::int32_t>(k), report.error);
  contribute(JoinReports{}, std::move(report), std::exchange(finished_, {}));
}

void Placer::build(std::int32_t k, FirstError& error) {
  Part& part = this->part(k);
  MeshPart& mesh = part.mesh;
  drop(part.asked);
  for (const auto& [id, tet] : part.halo) {
    mesh.tet_ids.push_back(id);
    mesh.tets.push_back(tet);
  }
  drop(part.halo);
  std::sort(part.points.begin(), part.points.end(), [k](const PartPoint& a, const PartPoint& b) {
    return std::pair(a.owner != k, a.id) < std::pair(b.owner != k, b.id);
  });
  const IdSet corners(mesh.tets);
  std::vector<VertexId> local(static_cast<std::size_t>(corners.size()));
  std::vector<std::pair<std::int32_t, std::size_t>> ghosts;  // owners and positions
  mesh.points.reserve(part.points.size());
  mesh.point_ids.reserve(part.points.size());
  for (const PartPoint& point : part.points) {
    const std::size_t at = mesh.points.size();
    if (corners.has(point.id))
      local[static_cast<std::size_t>(corners.rank(point.id))] = static_cast<VertexId>(at);
    if (point.owner == k)
      ++mesh.n_owned;
    else
      ghosts.emplace_back(point.owner, at);
    mesh.points.push_back(point.at);
    mesh.point_ids.push_back(point.id);
  }
  drop(part.points);
  for (Tet& tet : mesh.tets)
    for (VertexId& v : tet) v = local[static_cast<std::size_t>(corners.rank(v))];

  std::sort(ghosts.begin(), ghosts.end());
  for (auto ghost = ghosts.begin(); ghost != ghosts.end();) {
    GhostList list{ghost->first, k, {}, {}};
    for (; ghost != ghosts.end() && ghost->first == list.owner; ++ghost) {
      list.ids.push_back(static_cast<VertexId>(mesh.point_ids[ghost->second]));
      list.there.push_back(static_cast<std::int32_t>(ghost->second));
    }
    const PeId to = home_of(list.owner);
    group()[to].send<&Placer::receive_ghosts>(std::move(list));
  }

  const std::size_t n_fields = setup_.fields.size();
  part.rows.resize(mesh.points.size() * n_fields);
  for (std::size_t f = 0; f < n_fields; ++f) {
    const Formula formula = make_formula(setup_.fields[f].name, setup_.fields[f].domain);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      double& value = part.rows[v * n_fields + f];
      value = formula(mesh.points[v]);
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
    Part& part = parts_[k];
    setup_.workers[{first_part_ + static_cast<std::int32_t>(k)}].send<&Worker::load>(
        PartLoad{std::move(part.mesh), setup_.fields.size(), std::move(part.rows)});
  }
  drop(parts_);
}

}  // namespace tess::m2m
