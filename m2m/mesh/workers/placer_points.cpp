#include "m2m/mesh/workers/placer.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace tess::m2m {
namespace {

constexpr std::int32_t no_owner = std::numeric_limits<std::int32_t>::max();

}  // namespace

void Placer::make_drafts() {
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
  for (Draft& part : parts_) {
    part.mesh.n_own_tets = static_cast<std::int64_t>(part.mesh.tets.size());
    part.mesh.dimension = setup_.dimension;
    const IdSet vertices(part.mesh.tets);
    part.asked = vertices.list();
    part.points.resize(part.asked.size());
    if (!has_halo()) number_corners(part.mesh.tets, vertices);
  }
}

void Placer::ask_points_of_parts() {
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
  for (PointQuery& query : queries) send_query(std::move(query));
}

void Placer::send_query(PointQuery query) {
  ++n_answers_due_;
  const PeId to = query.to;
  group()[to].send<&Placer::receive_query>(std::move(query));
}

void Placer::receive_query(PointQuery query) {
  const bool of_corners = query.parts.empty();
  if (knows_ == Knows::owners || (knows_ == Knows::points && of_corners)) {
    if (setup_.is_survey) mark_used(query.ids);
    group()[query.from].send<&Placer::receive_points>(answer(query));
  } else if (knows_ != Knows::refused) {  // a refused mesh ends here
    queries_.push_back(std::move(query));
  }
}

void Placer::answer_parts(Callback<PlacerReport> finished) {
  finished_ = std::move(finished);
  const std::size_t n = points_.size();
  owners_.assign(n, no_owner);
  const auto for_each_use = [this](const auto& visit) {
    for (const PointQuery& query : queries_) {
      std::size_t at = 0;
      for (std::size_t run = 0; run < query.parts.size(); ++run)
        for (std::int32_t i = 0; i < query.sizes[run]; ++i, ++at)
          visit(static_cast<std::size_t>(query.ids[at] - first_point_), query.parts[run]);
    }
  };
  for_each_use(
      [this](std::size_t v, std::int32_t part) { owners_[v] = std::min(owners_[v], part); });
  if (has_halo()) {
    users_begin_.assign(n + 1, 0);
    for_each_use([this](std::size_t v, std::int32_t) { ++users_begin_[v + 1]; });
    for (std::size_t v = 0; v < n; ++v) users_begin_[v + 1] += users_begin_[v];
    users_.resize(users_begin_.back());
    std::vector<std::uint32_t> next(users_begin_.begin(), users_begin_.end() - 1);
    for_each_use([&](std::size_t v, std::int32_t part) { users_[next[v]++] = part; });
  }
  send_unused();
  knows_ = Knows::owners;
  std::vector<GhostUse> uses;
  if (!has_halo()) {
    for_each_use([&](std::size_t v, std::int32_t part) {
      const GhostUse use{owners_[v], part};
      if (use.owner != part && (uses.empty() || uses.back() != use)) uses.push_back(use);
    });
    sort_unique(uses);
  }
  for (PointQuery& query : queries_) {
    PointAnswer answer = this->answer(query);
    for (const std::int32_t part : query.parts)
      for (auto use = std::lower_bound(uses.begin(), uses.end(), GhostUse{part, 0});
           use != uses.end() && use->owner == part; ++use)
        answer.ghost_uses.push_back(*use);
    group()[query.from].send<&Placer::receive_points>(std::move(answer));
    query = {};
  }
  drop(queries_);
  if (!has_halo()) drop(points_);
  finish_if_complete();
}

void Placer::send_unused() {
  const GlobalId end = first_point_ + static_cast<GlobalId>(points_.size());
  for (GlobalId v = first_point_; v < end;) {
    const PeId to = home_of(owner_of_unused(v));
    std::vector<PartPoint> unused;
    for (const GlobalId stop = std::min(end, first_unused_of(first_part_of(to.value + 1)));
         v < stop; ++v) {
      const auto at = static_cast<std::size_t>(v - first_point_);
      if (owners_[at] != no_owner) continue;
      owners_[at] = owner_of_unused(v);
      unused.push_back({static_cast<VertexId>(v), owners_[at], points_[at]});
    }
    report_.n_unused += unused.size();
    group()[to].send<&Placer::receive_unused>(std::move(unused));
  }
}

PointAnswer Placer::answer(const PointQuery& query) const {
  PointAnswer answer;
  answer.parts = query.parts;
  answer.sizes = query.sizes;
  answer.points.reserve(query.ids.size());
  if (!query.parts.empty()) answer.owners.reserve(query.ids.size());
  for (const VertexId v : query.ids) {
    const auto at = static_cast<std::size_t>(v - first_point_);
    answer.points.push_back(points_[at]);
    if (query.parts.empty()) continue;
    answer.owners.push_back(owners_[at]);
    if (!has_halo()) continue;
    answer.n_users.push_back(static_cast<std::int32_t>(users_begin_[at + 1] - users_begin_[at]));
    answer.users.insert(answer.users.end(), users_.begin() + users_begin_[at],
                        users_.begin() + users_begin_[at + 1]);
  }
  answer.firsts.reserve(query.sizes.size());
  std::size_t at = 0;
  for (const std::int32_t size : query.sizes) {
    answer.firsts.push_back(query.ids[at]);
    at += static_cast<std::size_t>(size);
  }
  return answer;
}

void Placer::receive_points(const PointAnswer& answer) {
  --n_answers_due_;
  if (answer.parts.empty()) {
    std::copy(answer.points.begin(), answer.points.end(),
              far_points_.begin() + far_->rank(answer.firsts.front()));
    measure_if_complete();
    return;
  }
  std::size_t at = 0;
  std::size_t user = 0;
  for (std::size_t run = 0; run < answer.parts.size(); ++run) {
    const std::int32_t k = answer.parts[run];
    Draft& to = part(k);
    auto id = std::lower_bound(to.asked.begin(), to.asked.end(), answer.firsts[run]);
    auto point =
        to.points.begin() + static_cast<std::ptrdiff_t>(to.n_known) + (id - to.asked.begin());
    for (std::int32_t i = 0; i < answer.sizes[run]; ++i, ++at, ++id) {
      *point++ = {*id, answer.owners[at], answer.points[at]};
      if (!has_halo()) continue;
      for (const auto end = user + static_cast<std::size_t>(answer.n_users[at]); user < end; ++user)
        if (answer.users[user] != k) to.others.push_back({answer.users[user], *id});
    }
  }
  ghost_uses_.insert(ghost_uses_.end(), answer.ghost_uses.begin(), answer.ghost_uses.end());
  finish_if_complete();
}

void Placer::receive_unused(const std::vector<PartPoint>& unused) {
  for (const PartPoint& point : unused) part(point.owner).unused.push_back(point);
  --n_unused_due_;
  finish_if_complete();
}

void Placer::ask_around() {
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    Draft& part = parts_[k];
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

void Placer::index_tets(Draft& part) {
  std::vector<Tet> tets = part.mesh.tets;
  part.own_vertices.emplace(tets);
  number_corners(tets, *part.own_vertices);
  part.around.emplace(static_cast<std::size_t>(part.own_vertices->size()), tets);
}

void Placer::answer_around(const AroundQuery& query) {
  Draft& asked = part(query.part);
  if (!asked.own_vertices) index_tets(asked);
  std::vector<std::int32_t> found;
  for (const VertexId v : query.vertices) {
    const auto around = (*asked.around)[asked.own_vertices->rank(v)];
    found.insert(found.end(), around.begin(), around.end());
  }
  sort_unique(found);
  AroundAnswer answer{query.asker};
  for (const std::int32_t t : found) {
    const auto at = static_cast<std::size_t>(t);
    answer.tets.push_back({static_cast<std::int32_t>(asked.mesh.tet_ids[at]), asked.mesh.tets[at]});
  }
  const PeId to = home_of(query.asker);
  group()[to].send<&Placer::receive_around>(std::move(answer));
}

void Placer::receive_around(const AroundAnswer& answer) {
  std::vector<HaloTet>& halo = part(answer.asker).halo;
  halo.insert(halo.end(), answer.tets.begin(), answer.tets.end());
}

void Placer::ask_halo_points() {
  for (Draft& part : parts_) {
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
    part.n_known = part.points.size();
    part.points.resize(part.n_known + part.asked.size());
  }
  ask_points_of_parts();
}

}  // namespace tess::m2m
