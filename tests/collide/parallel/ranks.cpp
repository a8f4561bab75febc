// Collisions over real processes and on threads, compared with all pairs: run by ctest. Two clients
// per PE have boxes at random places, which move from round to round; a third of the boxes are
// equal, so that a voxel has more pairs than one message. Clients and voxels migrate between
// rounds, and clients while their pairs are found. In every other round one owner receives a pair,
// otherwise both. In some rounds boxes have capsules and are searched in pieces, which changes no
// pair. Then pairs within models count, for the owners of one model. Then boxes that move little
// are collided with a slack: of clients that stay, and in two colliders at once, of which one has
// clients and voxels that migrate between rounds.
#include "collide/collider.hpp"
#include "runtime/balance.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/capsule_of_box.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

using namespace tess;
using namespace tess::collide;

namespace {

constexpr std::int32_t n_rounds = 6;
constexpr std::int32_t first_slow_round = 100;
constexpr double slack = 0.01;

/// From this round on the boxes are those of the first, each moved by at most a quarter of the
/// slack per round, and none are equal.
std::vector<Aabb> slow_boxes_of(std::int32_t client, std::int32_t n_clients, std::int32_t round) {
  std::mt19937_64 random(static_cast<std::uint64_t>(client));
  std::uniform_real_distribution<double> place(0, 4), extent(0, 0.5), way(-1, 1);
  std::vector<Aabb> boxes(static_cast<std::size_t>(3600 / n_clients));
  for (Aabb& box : boxes)
    for (std::size_t k = 0; k < 3; ++k) {
      box.lo[k] = place(random) + slack / 4 * way(random) * (round - first_slow_round);
      box.hi[k] = box.lo[k] + extent(random);
    }
  return boxes;
}

std::vector<Aabb> boxes_of(std::int32_t client, std::int32_t n_clients, std::int32_t round) {
  if (round >= first_slow_round) return slow_boxes_of(client, n_clients, round);
  std::mt19937_64 random(static_cast<std::uint64_t>(100 * round + client));
  std::uniform_real_distribution<double> place(0, 4), extent(0, 0.5);
  std::vector<Aabb> boxes(static_cast<std::size_t>(3600 / n_clients));
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      boxes[i].lo[k] = i % 3 == 0 ? 1.1 : place(random);
      boxes[i].hi[k] = boxes[i].lo[k] + (i % 3 == 0 ? 0.1 : extent(random));
    }
  return boxes;
}
/// Even clients have model 0, odd ones 1.
ModelId model_of(std::int32_t client) {
  return static_cast<ModelId>(client % 2);
}

/// A sum over pairs, the same in any order.
struct Answer {
  std::uint64_t n = 0, hash = 0;

  /// With one owner, it is not known which of the two; of one owner, which object is `mine`.
  void add(OwnerId owner, OwnerId other, LocalPair pair, Receivers receivers) {
    if (receivers == Receivers::one_owner && other < owner) {
      std::swap(owner, other);
      std::swap(pair.mine, pair.theirs);
    }
    if (owner == other && pair.theirs < pair.mine) std::swap(pair.mine, pair.theirs);
    ++n;
    hash += mix(
        mix(static_cast<std::uint64_t>(owner) << 32 | static_cast<std::uint64_t>(other)) ^
        (static_cast<std::uint64_t>(pair.mine) << 32 | static_cast<std::uint64_t>(pair.theirs)));
  }
  friend Answer operator+(Answer a, const Answer& b) { return {a.n + b.n, a.hash + b.hash}; }
  friend bool operator==(const Answer&, const Answer&) = default;
};

Receivers receivers_in(std::int32_t round) {
  return round % 2 == 0 ? Receivers::one_owner : Receivers::both_owners;
}

/// With `only`, pairs within a model count, too.
Answer oracle(std::int32_t n_clients, std::int32_t round, std::optional<ModelId> only) {
  const Receivers receivers = receivers_in(round);
  std::vector<Item> all;
  for (std::int32_t client = 0; client < n_clients; ++client) {
    const std::vector<Aabb> boxes = boxes_of(client, n_clients, round);
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
      all.push_back({boxes[i], {owner_of(Index1{client}), LocalId{i}, model_of(client)}});
  }
  Answer answer;
  for (const auto& [box, a] : all)
    for (const auto& [other, b] : all) {
      const bool receives =
          only ? a.model == *only && (a.owner != b.owner || a.local < b.local)
               : a.model != b.model && (receivers == Receivers::both_owners || a.owner < b.owner);
      if (receives && overlap(box, other, Touching::counts))
        answer.add(a.owner, b.owner, {a.local, b.local}, receivers);
    }
  return answer;
}

class Client : public Chare<Client> {
 public:
  void submit(const Collider& collider, std::int32_t round) {
    answer_ = {};
    n_messages_ = 0;
    receivers_ = receivers_in(round);
    const std::int32_t me = index().x;
    moves_ = collider.options.slack == 0;
    const std::vector<Aabb> boxes = boxes_of(me, static_cast<std::int32_t>(array().size()), round);
    // In some rounds all boxes have capsules around them, in some those of even clients.
    std::vector<Capsule> capsules;
    if (collider.options.slack == 0 && (round % 3 == 1 || (round % 3 == 2 && me % 2 == 0)))
      capsules = test::capsules_of_boxes(boxes);
    collider.submit(Objects{owner_of(index()), model_of(me), boxes, {}, capsules});
  }
  /// Moves on after every third message, if there is no slack.
  void receive(const Hits& hits) {
    for (const LocalPair& pair : hits.pairs) answer_.add(hits.owner, hits.other, pair, receivers_);
    if (moves_ && ++n_messages_ % 3 == 0) move();
  }
  void gather(const Callback<Answer>& target) { contribute(sum, answer_, target); }
  void move() { migrate_to(PeId{(my_pe().value + 1) % n_pes()}); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(answer_, n_messages_, moves_, receivers_);
  }

 private:
  Answer answer_;
  std::int32_t n_messages_ = 0;
  bool moves_ = false;
  Receivers receivers_ = Receivers::both_owners;
};

/// The clients submit and receive the hits of a round, which are compared with all pairs.
Task collide_round(Collider collider, ArrayProxy<Client> clients, std::int32_t round,
                   std::optional<ModelId> only = {}) {
  const std::int32_t n_clients = 2 * n_pes();
  const HitReceivers to{report_to<&Client::receive>(clients), only, receivers_in(round)};
  co_await epoch([&] { clients.broadcast<&Client::submit>(collider, round); });
  co_await collider.run(to);
  const Answer answer = co_await clients.reduce<&Client::gather>(),
               expected = oracle(n_clients, round, only);
  TESS_CHECK(answer == expected, "round ", round, ": ", answer.n, " hits were reported, ",
             expected.n, " are right, or others than those");
}

/// Whether the last collision of a collider with a slack tested pairs that were kept.
Task add_if_kept(Collider collider, std::int32_t& n_kept) {
  const CollisionStatistics statistics = co_await collider.statistics();
  TESS_CHECK(statistics.n_kept > 0, "no pair of larger boxes was tested");
  n_kept += statistics.searched ? 0 : 1;
}

/// Pairs within models, too, to the owners of objects of model 0: each of a pair once.
Task collide_for_one_model() {
  Collider collider;
  ArrayProxy<Client> clients;
  co_await epoch([&] {
    collider = make_collider({.rules = {.within_model = WithinModel::test}});
    clients = create<Client>(range(2 * n_pes()));
  });
  co_await collide_round(collider, clients, first_slow_round + 1, ModelId{0});
  co_await epoch([&] {
    collider.destroy();
    clients.destroy();
  });
}

/// New clients, which do not migrate: what moves to another PE is searched again.
Task collide_slowly() {
  Collider collider;
  ArrayProxy<Client> clients;
  co_await epoch([&] {
    collider = make_collider({.rules = {.within_model = WithinModel::skip}, .slack = slack});
    clients = create<Client>(range(2 * n_pes()));
  });
  std::int32_t n_kept = 0;
  for (std::int32_t round = first_slow_round; round < first_slow_round + n_rounds; ++round) {
    co_await collide_round(collider, clients, round);
    co_await add_if_kept(collider, n_kept);
  }
  // The last round is a quarter of the slack outside of the first boxes.
  TESS_CHECK(n_kept == n_rounds - 2, n_kept, " rounds tested pairs that were kept");
  co_await epoch([&] {
    collider.destroy();
    clients.destroy();
  });
}

/// Two colliders at once. The clients of the first move on after every other round.
Task collide_two_at_once() {
  std::array<Collider, 2> colliders;
  std::array<ArrayProxy<Client>, 2> clients;
  co_await epoch([&] {
    colliders = {make_collider({.rules = {.within_model = WithinModel::skip}, .slack = slack}),
                 make_collider({.rules = {.within_model = WithinModel::skip}, .slack = 3 * slack})};
    for (ArrayProxy<Client>& of_one : clients) of_one = create<Client>(range(2 * n_pes()));
  });
  const BalancerProxy voxels = start_balancing(colliders[0].voxels, {.strategy = "rotate"});
  std::array<std::int32_t, 2> n_kept{};
  for (std::int32_t round = first_slow_round; round < first_slow_round + n_rounds; ++round) {
    Task first = collide_round(colliders[0], clients[0], round);
    Task second = collide_round(colliders[1], clients[1], round);
    co_await first;
    co_await second;
    for (std::size_t i = 0; i < 2; ++i) co_await add_if_kept(colliders[i], n_kept[i]);
    if (round % 2 != 0) co_await epoch([&] { clients[0].broadcast<&Client::move>(); });
    co_await voxels.round();
  }
  // The first searches in the rounds after its clients have moved, the second only once.
  const std::int32_t expected = n_pes() == 1 ? n_rounds - 2 : n_rounds / 2;
  TESS_CHECK(n_kept[0] == expected && n_kept[1] == n_rounds - 1, n_kept[0], " and ", n_kept[1],
             " rounds tested pairs that were kept");
  co_await epoch([&] {
    for (const Collider& collider : colliders) collider.destroy();
    for (const ArrayProxy<Client>& of_one : clients) of_one.destroy();
  });
}

Task collide_rounds() {
  const std::int32_t n_clients = 2 * n_pes();
  Collider collider;
  ArrayProxy<Client> clients;
  co_await epoch([&] {
    collider = make_collider({.rules = {.within_model = WithinModel::skip}, .piece_length = 0.2});
    clients = create<Client>(range(n_clients));
  });
  const BalancerProxy voxels = start_balancing(collider.voxels, {.strategy = "rotate"});
  for (std::int32_t round = 0; round < n_rounds; ++round) {
    co_await collide_round(collider, clients, round);
    co_await epoch([&] { clients.broadcast<&Client::move>(); });
    co_await voxels.round();
  }
  TESS_CHECK(n_pes() == 1 || voxels.history().front().n_moved > 0, "no voxel was moved");
  print("each of the hits of ", n_rounds, " rounds was reported once\n");
  co_await epoch([&] {
    collider.destroy();
    clients.destroy();
  });
  co_await collide_for_one_model();
  co_await collide_slowly();
  co_await collide_two_at_once();
}

}  // namespace

int main(int argc, char** argv) {
  return tess::run(argc, argv, &collide_rounds);
}
