#include "apps/collide_scene/run/parallel.hpp"

#include <algorithm>
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
