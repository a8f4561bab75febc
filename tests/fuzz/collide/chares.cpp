#include "collide/collider.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/fuzz/collide/comparison.hpp"
#include "tests/fuzz/collide/objects.hpp"

#include <fmt/format.h>
#include <functional>
#include <optional>

namespace collide_fuzz {
namespace {

using namespace tess::collide;

/// A scene, and the exact test of its objects.
struct Objects {
  std::vector<Aabb> boxes;
  std::vector<Capsule> capsules;  // or none
  std::vector<std::uint32_t> models;
  std::function<bool(std::uint32_t, std::uint32_t)> are_pair;
};

/// What all simulated PEs see; they share the memory of one process.
struct Problem {
  Look look;
  std::int32_t n_clients = 1;
  std::optional<ModelId> only;
  /// The first scene again: with a slack, its pairs are kept.
  static constexpr std::array<std::size_t, 3> scene_of_round{0, 0, 1};
  std::array<Objects, 2> scenes;
  std::array<PairList, 3> found;  ///< (mine, theirs), by the owner that received the pair
  bool is_refused = false;
};
Problem* problem = nullptr;

/// Owns every n-th object. Its local ids are the positions in the scene.
class Client : public tess::Chare<Client, tess::Index1> {
 public:
  void submit(const Collider& collider, std::size_t round) {
    round_ = round;
    const Objects& scene = scene_of(round);
    std::vector<Item> items;
    std::vector<Capsule> capsules;
    const bool with_capsules =
        problem->look.slack == 0 &&
        tess::unit(tess::mix(problem->look.seed + 7 * static_cast<std::uint64_t>(index().x))) <
            problem->look.with_capsules;
    for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
      if (owner(i) != index().x) continue;
      items.push_back(
          {scene.boxes[i],
           {owner_of(index()), static_cast<LocalId>(i), static_cast<ModelId>(scene.models[i])}});
      if (with_capsules && !scene.capsules.empty()) capsules.push_back(scene.capsules[i]);
    }
    collider.submit(items, capsules);
  }
  /// The exact test is the receiver's.
  void receive(const Hits& hits) {
    TESS_CHECK(hits.owner == owner_of(index()), "hits of another owner");
    for (const LocalPair& pair : hits.pairs) {
      const auto mine = static_cast<std::uint32_t>(pair.mine),
                 theirs = static_cast<std::uint32_t>(pair.theirs);
      if (scene_of(round_).are_pair(mine, theirs)) problem->found[round_].push_back({mine, theirs});
    }
  }
  [[nodiscard]] static std::int32_t owner(std::size_t object) {
    return static_cast<std::int32_t>(object % static_cast<std::size_t>(problem->n_clients));
  }
  void serialize(auto& ar) { ar(round_); }

 private:
  static const Objects& scene_of(std::size_t round) {
    return problem->scenes[Problem::scene_of_round[round]];
  }

  std::size_t round_ = 0;
};

tess::Task collide_rounds() {
  const Look& look = problem->look;
  const double size = look.voxel_size;
  const ColliderOptions options{.voxel_size = {size, size, size},
                                .rules = {look.touching, look.within_model},
                                .piece_length = look.piece_length,
                                .slack = look.slack};
  Collider collider;
  tess::ArrayProxy<Client> clients;
  co_await tess::epoch([&] {
    collider = make_collider(options);
    clients = tess::create<Client>(tess::range(problem->n_clients));
  });
  const HitReceivers to{report_to<&Client::receive>(clients), problem->only};
  for (std::size_t round = look.slack > 0 ? 0 : 1; round < 3; ++round) {
    co_await tess::epoch([&] { clients.broadcast<&Client::submit>(collider, round); });
    try {
      co_await collider.run(to);
    } catch (const tess::Error& error) {  // voxels that are too small for 32-bit cells
      const std::string_view why = error.what();
      if (size == 0 || (why.find("voxel size") == why.npos && why.find("voxel grid") == why.npos))
        throw;
      problem->is_refused = true;
    }
    // Ends all voxels; the next collision makes them again.
    if (look.seed % 3 == 1)
      for (int call = 0; call < 2; ++call) co_await tess::epoch([&] { collider.retire(); });
  }
  co_await tess::epoch([&] {
    collider.destroy();
    clients.destroy();
  });
}

/// Each owner of a pair receives it, once if they are the same; with `only` those whose object is of
/// that model.
PairList expected(const Objects& scene, const Problem& p) {
  PairList out;
  for (std::uint32_t i = 0; i < scene.boxes.size(); ++i)
    for (std::uint32_t j = i + 1; j < scene.boxes.size(); ++j) {
      const ModelId a{scene.models[i]}, b{scene.models[j]};
      if ((p.look.within_model == WithinModel::skip && a == b) || !scene.are_pair(i, j)) continue;
      const bool to_a = !p.only || a == *p.only, to_b = !p.only || b == *p.only;
      if (to_a) out.push_back({i, j});
      if (to_b && !(to_a && Client::owner(i) == Client::owner(j))) out.push_back({j, i});
    }
  return out;
}

/// The two objects of one owner are in no order.
PairList in_order(PairList list) {
  for (Pair& pair : list)
    if (Client::owner(pair.first) == Client::owner(pair.second) && pair.second < pair.first)
      std::swap(pair.first, pair.second);
  return list;
}

bool is_in_chares(Shape shape) {
  return shape != Shape::box_of_float && shape != Shape::box_in_2d &&
         shape != Shape::box_of_float_in_4d && shape != Shape::triangle_of_float;
}

Objects objects_of(const Look& look) {
  Objects out;
  with_objects(look, [&](auto objects, Drawer& drawer) {
    using Object = typename decltype(objects)::value_type;
    if constexpr (std::is_same_v<decltype(box_of(std::declval<const Object&>())), Aabb>) {
      for (const Object& object : objects) {
        out.boxes.push_back(box_of(object));
        if constexpr (tess::collide::detail::HasCapsule<Object>)
          out.capsules.push_back(capsule_of(object));
      }
      out.models = drawer.models();
      const auto kept = std::make_shared<const std::vector<Object>>(std::move(objects));
      out.are_pair = [kept, test = pair_test(*kept, look.touching)](
                         std::uint32_t i, std::uint32_t j) { return test(i, j); };
    }
  });
  return out;
}

}  // namespace

void compare_chares(const Look& look, std::int32_t n_pes, Comparison& out) {
  Problem here;
  here.look = look;
  if (!is_in_chares(look.shape)) here.look.shape = Shape::box;
  here.n_clients = static_cast<std::int32_t>(1 + look.seed % 7);
  if (look.seed % 5 == 0) here.only = ModelId{0};
  here.scenes[0] = objects_of(here.look);
  Look moved = here.look;
  moved.seed ^= 0xaaaa;
  here.scenes[1] = objects_of(moved);
  problem = &here;
  const tess::test::Machine machine{.pes = n_pes,
                                    .per_process = look.seed % 2 == 0 ? 1 : 0,
                                    .seed = look.seed,
                                    .migration = look.slack > 0 ? 0 : 0.05,
                                    .most_events = 0};
  const tess::test::Result result = machine.run([] { return collide_rounds(); });
  if (result.exit_code != 0 && out.failure.empty())
    out.failure = fmt::format("chares on {} PEs: {}", n_pes, result.failure());
  if (here.is_refused) ++out.n_refused;
  for (std::size_t round = look.slack > 0 ? 0 : 1; round < 3 && !here.is_refused; ++round)
    out.pairs(in_order(here.found[round]),
              in_order(expected(here.scenes[Problem::scene_of_round[round]], here)),
              fmt::format("collision {} on {} PEs", round, n_pes));
  problem = nullptr;
}

}  // namespace collide_fuzz
