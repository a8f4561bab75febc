// Collisions over real processes and on threads, compared with all pairs: run by ctest. Two clients
// per PE have boxes at random places, which move from round to round; a third of the boxes are equal,
// so that a voxel has more pairs than one message. Clients and voxels migrate between rounds, and
// clients while their pairs are found. In every other round one owner receives a pair, otherwise both. In
// some rounds boxes have capsules and are searched in pieces, which changes no pair.
#include "collide/collider.hpp"
#include "runtime/balance.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/capsule_of_box.hpp"

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

using namespace tess;
using namespace tess::collide;

namespace {

constexpr std::int32_t n_rounds = 6;

std::vector<Aabb> boxes_of(std::int32_t client, std::int32_t n_clients, std::int32_t round) {
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

  /// With one owner, it is not known which of the two.
  void add(OwnerId owner, OwnerId other, LocalPair pair, Receivers receivers) {
    if (receivers == Receivers::one_owner && other < owner) {
      std::swap(owner, other);
      std::swap(pair.mine, pair.theirs);
    }
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

Answer oracle(std::int32_t n_clients, std::int32_t round) {
  const Receivers receivers = receivers_in(round);
  std::vector<Item> all;
  for (std::int32_t client = 0; client < n_clients; ++client) {
    const std::vector<Aabb> boxes = boxes_of(client, n_clients, round);
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
      all.push_back({boxes[i], {owner_of(Index1{client}), LocalId{i}, model_of(client)}});
  }
  Answer answer;
  for (const auto& [box, a] : all)
    for (const auto& [other, b] : all)
      if (a.model != b.model && overlap(box, other, Touching::counts) &&
          (receivers == Receivers::both_owners || a.owner < b.owner))
        answer.add(a.owner, b.owner, {a.local, b.local}, receivers);
  return answer;
}

class Client : public Chare<Client> {
 public:
  void submit(const Collider& collider, std::int32_t round) {
    answer_ = {};
    n_messages_ = 0;
    receivers_ = receivers_in(round);
    const std::int32_t me = index().x;
    const std::vector<Aabb> boxes = boxes_of(me, static_cast<std::int32_t>(array().size()), round);
    // In some rounds all boxes have capsules around them, in some those of even clients.
    std::vector<Capsule> capsules;
    if (round % 3 == 1 || (round % 3 == 2 && me % 2 == 0))
      capsules = test::capsules_of_boxes(boxes);
    collider.submit(Objects{owner_of(index()), model_of(me), boxes, {}, capsules});
  }
  /// Moves on after every third message.
  void receive(const Hits& hits) {
    for (const LocalPair& pair : hits.pairs) answer_.add(hits.owner, hits.other, pair, receivers_);
    if (++n_messages_ % 3 == 0) move();
  }
  void gather(const Callback<Answer>& target) { contribute(sum, answer_, target); }
  void move() { migrate_to(PeId{(my_pe().value + 1) % n_pes()}); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(answer_, n_messages_, receivers_);
  }

 private:
  Answer answer_;
  std::int32_t n_messages_ = 0;
  Receivers receivers_ = Receivers::both_owners;
};

Task collide_rounds() {
  const std::int32_t n_clients = 2 * n_pes();
  Collider collider;
  ArrayProxy<Client> clients;
  co_await epoch([&] {
    collider = make_collider({.piece_length = 0.2});
    clients = create<Client>(range(n_clients));
  });
  const BalancerProxy voxels = start_balancing(collider.voxels, {.strategy = "rotate"});
  for (std::int32_t round = 0; round < n_rounds; ++round) {
    const Report report{report_to<&Client::receive>(clients), {}, receivers_in(round)};
    co_await epoch([&] { clients.broadcast<&Client::submit>(collider, round); });
    co_await run_collision(collider, report);
    Future<Answer> done;
    clients.broadcast<&Client::gather>(done.callback());
    const Answer answer = co_await done, expected = oracle(n_clients, round);
    TESS_CHECK(answer == expected, "round ", round, ": ", answer.n, " hits were reported, ",
               expected.n, " are right, or others than those");
    co_await epoch([&] { clients.broadcast<&Client::move>(); });
    co_await voxels.round();
  }
  TESS_CHECK(n_pes() == 1 || voxels.history().front().n_moved > 0, "no voxel was moved");
  print("each of the hits of ", n_rounds, " rounds was reported once\n");
  co_await epoch([&] {
    collider.destroy();
    clients.destroy();
  });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::run(argc, argv, &collide_rounds);
}
