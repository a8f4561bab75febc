#include "m2m/parallel/worker.hpp"

#include "m2m/search/nearest_vertex.hpp"

#include <algorithm>

namespace tess::m2m {
namespace {

Item item_of(const Aabb& box, Index1 owner, std::size_t local, ModelId model) {
  return Item{box, ObjectId{owner_of(owner), static_cast<LocalId>(local), model}};
}

std::int32_t as_row(LocalId id) {
  return static_cast<std::int32_t>(id);
}

}  // namespace

Outcome JoinOutcomes::operator()(Outcome a, const Outcome& b) const {
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  a.status.insert(a.status.end(), b.status.begin(), b.status.end());
  a.values.insert(a.values.end(), b.values.begin(), b.values.end());
  a.n_candidates += b.n_candidates;
  return a;
}

void Worker::load(MeshPart part, std::vector<double> values) {
  part_ = std::move(part);
  values_ = std::move(values);
}

void Worker::submit_tets(const TransferSetup& setup) {
  setup_ = setup;
  std::vector<Item> items;
  items.reserve(part_.tets.size());
  for (std::size_t t = 0; t < part_.tets.size(); ++t)
    items.push_back(
        item_of(search_box(corners_of(part_.points, part_.tets[t])), index(), t, source_model));
  setup.collider.submit(std::move(items));
}

void Worker::submit_points(const TransferSetup& setup) {
  setup_ = setup;
  hits_.clear();
  n_candidates_ = 0;
  const auto n_owned = static_cast<std::size_t>(part_.n_owned);
  claims_.assign(n_owned, Candidate{});
  nearest_.clear();
  std::vector<Item> items;
  items.reserve(n_owned);
  for (std::size_t v = 0; v < n_owned; ++v)
    items.push_back(item_of(box_of(part_.points[v]), index(), v, target_model));
  setup.collider.submit(std::move(items));
}

void Worker::receive_hits(Hits hits) {
  n_candidates_ += hits.pairs.size();
  hits_.push_back(std::move(hits));
}

void Worker::ask_sources() {
  std::vector<Hits> all = std::exchange(hits_, {});
  std::vector<Query> queries;
  std::vector<OwnerId> sources;  // whom each query asks; few, so that they are sought one by one
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
  std::vector<std::int32_t> place(n_owned, -1);  // of a row in the query at hand
  std::vector<std::vector<std::uint32_t>> hits_of(sources.size());
  for (std::size_t h = 0; h < all.size(); ++h)
    hits_of[query_of[h]].push_back(static_cast<std::uint32_t>(h));
  for (std::size_t q = 0; q < queries.size(); ++q) {
    Query& query = queries[q];
    query.from = index();
    query.pairs.reserve(n_pairs[q]);
    query.rows.reserve(std::min(n_owned, n_pairs[q]));
    for (const std::uint32_t h : hits_of[q]) {
      for (const LocalPair& pair : all[h].pairs) {
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
    setup_.source[index_of(sources[q])].send<&Worker::answer>(std::move(query));
  }
}

void Worker::answer(Query query) {
  std::vector<Found> found;
  locate_pairs(part_.points, part_.tets, query.points, query.pairs, found);
  std::vector<Candidate> best(query.rows.size());
  std::vector<const Found*> winner(query.rows.size(), nullptr);
  for (const Found& f : found) {
    const PointPair& pair = query.pairs[static_cast<std::size_t>(f.pair)];
    const auto point = static_cast<std::size_t>(pair.point);
    const Candidate claim{
        f.location.violation, part_.tet_ids[static_cast<std::size_t>(pair.tet)], f.location.status};
    if (!better(claim, best[point])) continue;
    best[point] = claim;
    winner[point] = &f;
  }
  Answer answer;
  const std::size_t n = setup_.n_components;
  answer.rows.reserve(best.size());
  answer.claims.reserve(best.size());
  answer.values.reserve(best.size() * n);
  for (std::size_t point = 0; point < best.size(); ++point) {
    if (winner[point] == nullptr) continue;
    const Found& f = *winner[point];
    const Tet& tet =
        part_.tets[static_cast<std::size_t>(query.pairs[static_cast<std::size_t>(f.pair)].tet)];
    answer.rows.push_back(query.rows[point]);
    answer.claims.push_back(best[point]);
    for (std::size_t c = 0; c < n; ++c)
      answer.values.push_back(weigh(f.location.weights, tet, values_.data() + c, n));
  }
  if (!answer.rows.empty())
    setup_.target[query.from].send<&Worker::receive_answer>(std::move(answer));
}

void Worker::receive_answer(const Answer& answer) {
  const std::size_t n = setup_.n_components;
  for (std::size_t i = 0; i < answer.rows.size(); ++i) {
    Candidate& mine = claims_[static_cast<std::size_t>(answer.rows[i])];
    if (!better(answer.claims[i], mine)) continue;
    mine = answer.claims[i];
    std::copy_n(answer.values.data() + i * n, n, row(answer.rows[i]));
  }
}

void Worker::settle(const OutsidePolicy& policy) {
  NearestQuery query{index(), {}, {}};
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(part_.n_owned); ++v) {
    if (claims_[static_cast<std::size_t>(v)].status != Status::outside) continue;
    if (const auto* given = std::get_if<UseValue>(&policy))
      std::fill_n(row(v), setup_.n_components, given->value);
    if (!std::holds_alternative<Nearest>(policy)) continue;
    query.rows.push_back(v);
    query.points.push_back(part_.points[static_cast<std::size_t>(v)]);
  }
  if (query.rows.empty()) return;
  nearest_.assign(static_cast<std::size_t>(part_.n_owned), NearestClaim{});
  for (std::int32_t k = 0; k < setup_.n_source_parts; ++k)
    setup_.source[{k}].send<&Worker::answer_nearest>(query);
}

void Worker::answer_nearest(NearestQuery query) {
  if (part_.points.empty()) return;
  const NearestVertex nearest(part_.points);
  NearestAnswer answer;
  answer.rows = std::move(query.rows);
  for (const Point& point : query.points) {
    const NearestVertex::Answer found = nearest.find(point);
    answer.squared_distances.push_back(found.squared_distance);
    answer.vertices.push_back(part_.point_ids[static_cast<std::size_t>(found.vertex)]);
    const double* values = row(found.vertex);
    answer.values.insert(answer.values.end(), values, values + setup_.n_components);
  }
  setup_.target[query.from].send<&Worker::receive_nearest>(std::move(answer));
}

void Worker::receive_nearest(const NearestAnswer& answer) {
  const std::size_t n = setup_.n_components;
  for (std::size_t i = 0; i < answer.rows.size(); ++i) {
    NearestClaim& mine = nearest_[static_cast<std::size_t>(answer.rows[i])];
    const double d = answer.squared_distances[i];
    if (d > mine.squared_distance ||
        (d == mine.squared_distance && answer.vertices[i] >= mine.vertex))
      continue;
    mine = {d, answer.vertices[i]};
    std::copy_n(answer.values.data() + i * n, n, row(answer.rows[i]));
  }
}

void Worker::gather(Callback<Outcome> target) {
  Outcome outcome;
  const auto n_owned = static_cast<std::size_t>(part_.n_owned);
  outcome.points.assign(part_.point_ids.begin(), part_.point_ids.begin() + part_.n_owned);
  for (const Candidate& claim : claims_) outcome.status.push_back(claim.status);
  outcome.values.assign(
      values_.begin(),
      values_.begin() + static_cast<std::ptrdiff_t>(n_owned * setup_.n_components));
  outcome.n_candidates = n_candidates_;
  contribute(JoinOutcomes{}, std::move(outcome), std::move(target));
}

}  // namespace tess::m2m
