#include "m2m/parallel/worker.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

std::int32_t as_row(collide::LocalId id) {
  return static_cast<std::int32_t>(id);
}

void call_target(const Callback<collide::Hits>& callback, collide::Hits&& hits) {
  const auto [target, transfer] =
      from_bytes<std::tuple<CollectionId, TransferId>>(callback.where());
  const auto owner = collide::index_of<Index1>(hits.owner);
  ArrayProxy<Worker>(target)[owner].send<&Worker::receive_hits>(transfer, std::move(hits));
}
const Callback<collide::Hits>::Kind target_kind{naming::name_of<&call_target>(), &call_target};

}  // namespace

Outcome JoinOutcomes::operator()(Outcome a, const Outcome& b) const {
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  a.status.insert(a.status.end(), b.status.begin(), b.status.end());
  a.values.insert(a.values.end(), b.values.begin(), b.values.end());
  return a;
}

Callback<collide::Hits> report_to_target(ArrayProxy<Worker> target, TransferId transfer) {
  return Callback<collide::Hits>(target_kind, to_bytes(std::tuple(target.id(), transfer)));
}

void Worker::load(PartLoad load) {
  part_ = std::move(load.part);
  n_components_ = load.n_components;
  values_ = std::move(load.values);
  status_.assign(static_cast<std::size_t>(part_.n_owned), Status::outside);
}

Worker::Outgoing& Worker::outgoing(TransferId transfer) {
  const auto at = outgoing_.find(transfer);
  TESS_CHECK(at != outgoing_.end(), "this Worker is not a source of the transfer");
  return at->second;
}

Worker::Incoming& Worker::incoming(TransferId transfer) {
  const auto at = incoming_.find(transfer);
  TESS_CHECK(at != incoming_.end(), "this Worker is not a target of the transfer");
  return at->second;
}

void Worker::set_row(Incoming& to, std::int32_t point, const double* values) const {
  std::copy_n(values, n_components_, row(to.values, point));
  to.is_new[static_cast<std::size_t>(point)] = 1;
}

void Worker::submit_tets(const TransferSetup& setup) {
  outgoing_.emplace(setup.id, Outgoing{setup});
  collide::Objects tets{collide::owner_of(index()), source_model, {}};
  tets.boxes.reserve(part_.tets.size());
  for (const auto& tet : part_.tets)
    tets.boxes.push_back(search_box(corners_of(part_.points, tet)));
  setup.collider.submit(std::move(tets));
}

void Worker::submit_points(const TransferSetup& setup) {
  const auto n_owned = static_cast<std::size_t>(part_.n_owned);
  Incoming& to = incoming_.emplace(setup.id, Incoming{setup}).first->second;
  to.best.resize(n_owned);
  to.values.resize(values_.size());
  to.is_new.resize(part_.points.size());
  collide::Objects points{collide::owner_of(index()), target_model, {}};
  points.boxes.reserve(n_owned);
  for (std::size_t v = 0; v < n_owned; ++v)
    points.boxes.push_back(collide::box_of(part_.points[v]));
  setup.collider.submit(std::move(points));
}

void Worker::receive_hits(TransferId transfer, collide::Hits hits) {
  Incoming& to = incoming(transfer);
  to.n_candidates += hits.pairs.size();
  to.hits.push_back(std::move(hits));
}

void Worker::ask_sources(TransferId transfer) {
  Incoming& to = incoming(transfer);
  std::vector<collide::Hits> all = std::exchange(to.hits, {});
  std::vector<Query> queries;
  std::vector<collide::OwnerId> sources;  // per query; few, so a linear search is enough
  std::vector<std::uint32_t> query_of(all.size());
  std::vector<std::size_t> n_pairs;
  for (std::size_t h = 0; h < all.size(); ++h) {
    const auto known = std::find(sources.begin(), sources.end(), all[h].other);
    query_of[h] = static_cast<std::uint32_t>(known - sources.begin());
    if (known == sources.end()) {
      sources.push_back(all[h].other);
      n_pairs.push_back(0);
    }
    n_pairs[query_of[h]] += all[h].pairs.size();
  }
  queries.resize(sources.size());
  const auto n_owned = static_cast<std::size_t>(part_.n_owned);
  std::vector<std::int32_t> place(n_owned, -1);  // per row: its index in the current query
  std::vector<std::vector<std::uint32_t>> hits_of(sources.size());
  for (std::size_t h = 0; h < all.size(); ++h)
    hits_of[query_of[h]].push_back(static_cast<std::uint32_t>(h));
  for (std::size_t q = 0; q < queries.size(); ++q) {
    Query& query = queries[q];
    query.transfer = transfer;
    query.from = index();
    query.pairs.reserve(n_pairs[q]);
    query.rows.reserve(std::min(n_owned, n_pairs[q]));
    for (const std::uint32_t h : hits_of[q]) {
      for (const collide::LocalPair& pair : all[h].pairs) {
        std::int32_t& at = place[static_cast<std::size_t>(pair.mine)];
        if (at < 0) {
          at = static_cast<std::int32_t>(query.rows.size());
          query.rows.push_back(as_row(pair.mine));
        }
        query.pairs.push_back({as_row(pair.theirs), at});
      }
      all[h].pairs = {};
    }
    query.points.reserve(query.rows.size());
    for (const std::int32_t row : query.rows) {
      query.points.push_back(part_.points[static_cast<std::size_t>(row)]);
      place[static_cast<std::size_t>(row)] = -1;
    }
    to.setup.source[collide::index_of(sources[q])].send<&Worker::answer>(std::move(query));
  }
}

void Worker::answer(Query query) {
  const Outgoing& from = outgoing(query.transfer);
  const std::vector<double>& values = from.values ? *from.values : values_;
  std::vector<Found> found;
  locate_pairs(part_.points, part_.tets, query.points, query.pairs, found);
  std::vector<Candidate> best(query.rows.size());
  std::vector<const Found*> winner(query.rows.size(), nullptr);
  for (const Found& f : found) {
    const PointPair& pair = query.pairs[static_cast<std::size_t>(f.pair)];
    const auto point = static_cast<std::size_t>(pair.point);
    const Candidate candidate =
        candidate_of(f.location, part_.tet_ids[static_cast<std::size_t>(pair.tet)]);
    if (!better(candidate, best[point])) continue;
    best[point] = candidate;
    winner[point] = &f;
  }
  Answer answer{query.transfer, {}, {}, {}};
  const std::size_t n = n_components_;
  answer.rows.reserve(best.size());
  answer.candidates.reserve(best.size());
  answer.values.reserve(best.size() * n);
  for (std::size_t point = 0; point < best.size(); ++point) {
    if (winner[point] == nullptr) continue;
    const Found& f = *winner[point];
    const Tet& tet =
        part_.tets[static_cast<std::size_t>(query.pairs[static_cast<std::size_t>(f.pair)].tet)];
    answer.rows.push_back(query.rows[point]);
    answer.candidates.push_back(best[point]);
    for (std::size_t c = 0; c < n; ++c)
      answer.values.push_back(interpolated(f.location.weights, tet, values.data() + c, n));
  }
  if (!answer.rows.empty())
    from.setup.target[query.from].send<&Worker::receive_answer>(std::move(answer));
}

void Worker::receive_answer(const Answer& answer) {
  Incoming& to = incoming(answer.transfer);
  for (std::size_t i = 0; i < answer.rows.size(); ++i) {
    Candidate& mine = to.best[static_cast<std::size_t>(answer.rows[i])];
    if (!better(answer.candidates[i], mine)) continue;
    mine = answer.candidates[i];
    set_row(to, answer.rows[i], answer.values.data() + i * n_components_);
  }
}

void Worker::resolve_outside(const OutsideRequest& request) {
  Incoming& to = incoming(request.transfer);
  if (std::holds_alternative<Keep>(request.policy)) return;
  std::vector<std::int32_t> outside;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(part_.n_owned); ++v)
    if (to.best[static_cast<std::size_t>(v)].status == Status::outside) outside.push_back(v);
  if (outside.empty()) return;
  if (const auto* given = std::get_if<UseValue>(&request.policy)) {
    const std::vector<double> given_row(n_components_, given->value);
    for (const std::int32_t v : outside) set_row(to, v, given_row.data());
    return;
  }
  Aabb box = collide::box_of(part_.points[static_cast<std::size_t>(outside.front())]);
  for (const std::int32_t v : outside)
    box = collide::merged(box, collide::box_of(part_.points[static_cast<std::size_t>(v)]));
  to.nearest_parts = NearestParts(request.source_boxes, box);
  to.nearest.resize(to.best.size());
  ask_nearest(to, outside);
}

void Worker::ask_nearest(Incoming& to, std::span<const std::int32_t> rows) {
  std::map<std::int32_t, NearestQuery> queries;  // by part
  for (const std::int32_t v : rows) {
    NearestSoFar& mine = to.nearest[static_cast<std::size_t>(v)];
    const Point& point = part_.points[static_cast<std::size_t>(v)];
    const NearestParts::Part next = to.nearest_parts.next(point, mine.asked);
    if (next == NearestParts::none || next.squared_distance > mine.squared_distance) continue;
    mine.asked = next;
    NearestQuery& query = queries[next.number];
    query.rows.push_back(v);
    query.points.push_back(point);
    query.squared_reaches.push_back(mine.squared_distance);
  }
  for (auto& [part, query] : queries) {
    query.transfer = to.setup.id;
    query.from = index();
    to.setup.source[{part}].send<&Worker::answer_nearest>(std::move(query));
  }
}

void Worker::answer_nearest(NearestQuery query) {
  Outgoing& from = outgoing(query.transfer);
  std::vector<double>& values = from.values ? *from.values : values_;
  if (!nearest_)
    nearest_.emplace(std::span(part_.points).first(static_cast<std::size_t>(part_.n_owned)));
  NearestAnswer answer{query.transfer, std::move(query.rows), {}, {}, {}};
  answer.squared_distances.reserve(answer.rows.size());
  answer.vertices.reserve(answer.rows.size());
  answer.values.resize(answer.rows.size() * n_components_);
  for (std::size_t i = 0; i < answer.rows.size(); ++i) {
    const NearestVertex::Answer found = nearest_->find(query.points[i], query.squared_reaches[i]);
    answer.squared_distances.push_back(found.squared_distance);
    answer.vertices.push_back(
        found.vertex < 0 ? -1 : part_.point_ids[static_cast<std::size_t>(found.vertex)]);
    if (found.vertex >= 0)
      std::copy_n(row(values, found.vertex), n_components_,
                  answer.values.data() + i * n_components_);
  }
  from.setup.target[query.from].send<&Worker::receive_nearest>(std::move(answer));
}

void Worker::receive_nearest(const NearestAnswer& answer) {
  Incoming& to = incoming(answer.transfer);
  for (std::size_t i = 0; i < answer.rows.size(); ++i) {
    NearestSoFar& mine = to.nearest[static_cast<std::size_t>(answer.rows[i])];
    const double d = answer.squared_distances[i];
    const GlobalId vertex = answer.vertices[i];
    if (vertex < 0 || d > mine.squared_distance ||
        (d == mine.squared_distance && vertex >= mine.vertex))
      continue;
    mine.squared_distance = d;
    mine.vertex = vertex;
    set_row(to, answer.rows[i], answer.values.data() + i * n_components_);
  }
  ask_nearest(to, answer.rows);
}

void Worker::send_ghosts(TransferId transfer) {
  Incoming& to = incoming(transfer);
  for (const Ghosts& ghosts : part_.ghosts) {
    GhostRows message{transfer, {}, {}};
    for (std::size_t i = 0; i < ghosts.here.size(); ++i) {
      const std::int32_t v = ghosts.here[i];
      if (to.is_new[static_cast<std::size_t>(v)] == 0) continue;
      message.rows.push_back(ghosts.there[i]);
      const double* values = row(to.values, v);
      message.values.insert(message.values.end(), values, values + n_components_);
    }
    if (!message.rows.empty())
      array()[{ghosts.part}].send<&Worker::receive_ghosts>(std::move(message));
  }
}

void Worker::receive_ghosts(const GhostRows& ghosts) {
  Incoming& to = incoming(ghosts.transfer);
  for (std::size_t i = 0; i < ghosts.rows.size(); ++i)
    set_row(to, ghosts.rows[i], ghosts.values.data() + i * n_components_);
}

void Worker::commit(TransferId transfer, Callback<Tally> tally) {
  Incoming to = std::move(incoming(transfer));
  incoming_.erase(transfer);
  for (auto& [id, from] : outgoing_)
    if (!from.values) from.values = values_;
  for (std::size_t v = 0; v < to.is_new.size(); ++v) {
    if (to.is_new[v] == 0) continue;
    const auto point = static_cast<std::int32_t>(v);
    std::copy_n(row(to.values, point), n_components_, row(values_, point));
  }
  Tally mine{{}, to.n_candidates};
  for (std::size_t v = 0; v < status_.size(); ++v) {
    status_[v] = to.best[v].status;
    ++mine.counts[static_cast<std::size_t>(status_[v])];
  }
  contribute(AddTallies{}, mine, std::move(tally));
}

void Worker::release(TransferId transfer) {
  outgoing_.erase(transfer);
}

void Worker::gather(Callback<Outcome> target) {
  const auto owned = static_cast<std::ptrdiff_t>(part_.n_owned);
  const auto n = static_cast<std::ptrdiff_t>(n_components_);
  Outcome outcome{{part_.point_ids.begin(), part_.point_ids.begin() + owned},
                  status_,
                  {values_.begin(), values_.begin() + owned * n}};
  contribute(JoinOutcomes{}, std::move(outcome), std::move(target));
}

}  // namespace tess::m2m
