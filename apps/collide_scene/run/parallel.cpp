#include "apps/collide_scene/run/parallel.hpp"

#include "collide/pairs.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace collide_scene {

using namespace tess::collide;

namespace {

template <class T>
std::vector<T> part(const std::vector<T>& all, std::size_t begin, std::size_t end) {
  if (all.empty()) return {};
  const auto at = [&](std::size_t i) { return all.begin() + static_cast<std::ptrdiff_t>(i); };
  return {at(begin), at(end)};
}

}  // namespace

std::uint32_t first_of(std::int32_t client, std::uint64_t n_objects) {
  // Positions have 32 bits, and there are fewer clients than 2^31.
  return static_cast<std::uint32_t>(n_objects * static_cast<std::uint64_t>(client) /
                                    static_cast<std::uint64_t>(tess::n_pes()));
}

void Client::take(Piece piece) {
  piece_ = std::move(piece);
  forget();
}

void Client::submit(const Collider& collider) {
  boxes_ = piece_.boxes;
  boxes_.reserve(piece_.triangles.size() + piece_.boxes.size());
  for (const Triangle& triangle : piece_.triangles) boxes_.push_back(box_of(triangle));
  // Without exact tests the pairs of boxes are the answer.
  std::vector<Capsule> capsules;
  if (piece_.exact && collider.options.slack == 0)
    capsules = thin_capsules_of(std::span<const Triangle>(piece_.triangles));
  const std::vector<std::uint32_t>& models = piece_.models;
  // One list per run of a model.
  for (std::size_t begin = 0, end = 0; begin < boxes_.size(); begin = end) {
    end = models.empty() ? boxes_.size() : begin + 1;
    while (end < boxes_.size() && models[end] == models[begin]) ++end;
    collider.submit(
        Objects{owner_of(index()), ModelId{models.empty() ? 0 : models[begin]},
                std::span(boxes_).subspan(begin, end - begin), static_cast<LocalId>(begin),
                capsules.empty() ? std::span<const Capsule>()
                                 : std::span<const Capsule>(capsules).subspan(begin, end - begin)});
  }
}

void Client::receive(const Hits& hits) {
  answer_.n_candidates += hits.pairs.size();
  const std::uint32_t my_first = first_of(index().x, piece_.n_objects),
                      their_first = first_of(index_of(hits.other).x, piece_.n_objects);
  Candidates candidates;
  std::unordered_map<std::uint32_t, std::uint32_t> sent;
  for (const LocalPair& pair : hits.pairs) {
    const auto mine = static_cast<std::uint32_t>(pair.mine),
               theirs = static_cast<std::uint32_t>(pair.theirs);
    const ScenePair in_scene{my_first + mine, their_first + theirs};
    if (!piece_.exact) {
      found(in_scene);
    } else if (hits.owner == hits.other) {
      if (meet(piece_.triangles[mine], piece_.triangles[theirs])) found(in_scene);
    } else {
      const auto [at, is_new] =
          sent.try_emplace(mine, static_cast<std::uint32_t>(candidates.triangles.size()));
      if (is_new) candidates.triangles.push_back(piece_.triangles[mine]);
      candidates.pairs.push_back({in_scene, at->second, theirs});
    }
  }
  if (!candidates.pairs.empty())
    array()[index_of(hits.other)].send<&Client::test>(std::move(candidates));
}

void Client::test(const Candidates& candidates) {
  for (const auto& [pair, triangle, mine] : candidates.pairs)
    if (meet(candidates.triangles[triangle], piece_.triangles[mine])) found(pair);
}

bool Client::meet(const Triangle& a, const Triangle& b) const {
  return intersect(a, b, piece_.open ? Touching::does_not_count : Touching::counts);
}

void Client::found(ScenePair pair) {
  if (pair.first > pair.second) std::swap(pair.first, pair.second);
  answer_.add(pair, piece_.step);
  if (piece_.keep_pairs) pairs_.push_back(pair);
}

void Client::forget() {
  answer_ = {};
  pairs_.clear();
}

void Client::give_answer(tess::Callback<Answer> target) {
  contribute(AddAnswers{}, answer_, std::move(target));
}

void Client::give_pairs(tess::Callback<std::vector<ScenePair>> target) {
  contribute(tess::concatenate, std::move(pairs_), std::move(target));
  pairs_ = {};
}

void Client::give_memory(tess::Callback<std::uint64_t> target) {
  const tess::Machine& machine = tess::machine();
  const tess::PeId here = tess::my_pe();
  // All simulated processes share the memory of process 0.
  const bool first =
      machine.process_of(here) == machine.process() && machine.is_first_of_process(here);
  contribute(tess::sum, first ? peak_memory_bytes() : 0, std::move(target));
}

ParallelCollisions::ParallelCollisions(const Scene& scene, const Rules& rules,
                                       const SimulatedCosts& costs)
    : scene_(scene), rules_(rules), costs_(costs) {}

tess::Task ParallelCollisions::begin() {
  const PairRules pair_rules{rules_.open ? Touching::does_not_count : Touching::counts,
                             scene_.models.empty() ? WithinModel::test : rules_.within_model};
  const double size = rules_.voxel_size;  // zero: chosen
  const ColliderOptions options{.voxel_size = {size, size, size},
                                .rules = pair_rules,
                                .slack = rules_.slack,
                                .simulated_costs = costs_};
  co_await tess::epoch([&] {
    collider_ = make_collider(options);
    clients_ = tess::create<Client>(tess::range(tess::n_pes()));
  });
}

tess::Task ParallelCollisions::step(int step, int repeat, StepResult& result,
                                    std::vector<ScenePair>* pairs) {
  co_await tess::epoch([&] {
    for (std::int32_t c = 0; c < tess::n_pes(); ++c) {
      const std::size_t begin = first_of(c, scene_.n_objects()),
                        end = first_of(c + 1, scene_.n_objects());
      Piece piece{.n_objects = scene_.n_objects(),
                  .exact = rules_.triangles,
                  .open = rules_.open,
                  .keep_pairs = pairs != nullptr,
                  .step = step};
      piece.triangles = part(scene_.triangles, begin, end);
      piece.boxes = part(scene_.boxes, begin, end);
      piece.models = part(scene_.models, begin, end);
      clients_[{c}].send<&Client::take>(std::move(piece));
    }
  });
  const HitReceivers to{report_to<&Client::receive>(clients_), {}, Receivers::one_owner};
  for (int run = 0; run < repeat; ++run) {
    if (run > 0) co_await tess::epoch([&] { clients_.broadcast<&Client::forget>(); });
    const tess::Time begin = tess::now();
    co_await tess::epoch([&] { clients_.broadcast<&Client::submit>(collider_); });
    co_await collider_.run(to);
    const double seconds = tess::seconds(tess::now() - begin);
    result.seconds = run == 0 ? seconds : std::min(result.seconds, seconds);
    const CollisionStatistics statistics = co_await collider_.statistics();
    result.n_kept = statistics.n_kept;
    result.searched = statistics.searched;
    if (result.searched) last_ = statistics;
  }
  result.answer = co_await clients_.reduce<&Client::give_answer>();
  if (pairs == nullptr) co_return;
  *pairs = co_await clients_.reduce<&Client::give_pairs>();
}

tess::Task ParallelCollisions::end(RunResult& result) {
  result.grid.counts = last_.grid;
  result.grid.pieces = last_.n_pieces;
  result.peak_memory_bytes = co_await clients_.reduce<&Client::give_memory>();
  co_await tess::epoch([&] {
    collider_.destroy();
    clients_.destroy();
  });
}

}  // namespace collide_scene
