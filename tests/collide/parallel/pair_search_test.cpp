// Voxels with more pairs than are sent at once.
#include "collide/parallel/pair_search.hpp"

#include "collide/collider.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/capsule_of_box.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <array>
#include <fmt/format.h>
#include <span>
#include <string>
#include <vector>

namespace {

using namespace tess;
using namespace tess::collide;

/// Whose models the boxes have.
enum class Models { of_crowds, of_boxes };

/// Owns equal boxes, and adds up what it receives.
class Crowd : public Chare<Crowd> {
 public:
  void submit(const Collider& collider, std::int32_t n_boxes, bool in_pieces, Models models) {
    const std::vector<Aabb> boxes(static_cast<std::size_t>(n_boxes), Aabb{{0, 0, 0}, {1, 1, 1}});
    if (models == Models::of_boxes) {
      std::vector<Item> items;
      for (std::int32_t i = 0; i < n_boxes; ++i)
        items.push_back({boxes[0],
                         {owner_of(index()), static_cast<LocalId>(i),
                          static_cast<ModelId>(2 * i + index().x)}});
      collider.submit(items);
      return;
    }
    std::vector<Capsule> capsules;
    if (in_pieces) capsules = test::capsules_of_boxes(boxes);
    collider.submit(
        Objects{owner_of(index()), static_cast<ModelId>(index().x), boxes, {}, capsules});
  }
  void receive(const Hits& hits) {
    largest_ = std::max<std::uint64_t>(largest_, hits.pairs.size());
    ++n_messages_;
    for (const auto& [mine, theirs] : hits.pairs) {
      ++n_;
      sum_ += static_cast<std::uint64_t>(mine) * static_cast<std::uint64_t>(theirs);
    }
  }
  void gather(Callback<std::vector<std::uint64_t>> target) {
    contribute(concatenate, std::vector{n_, sum_, largest_, n_messages_}, std::move(target));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_, sum_, largest_, n_messages_);
  }

 private:
  std::uint64_t n_ = 0, sum_ = 0, largest_ = 0, n_messages_ = 0;
};

Task collide_crowds(std::int32_t n_boxes, bool in_pieces, Models models, PairRules rules,
                    std::vector<std::uint64_t>& received) {
  Collider collider;
  ArrayProxy<Crowd> crowds;
  co_await epoch([&] {
    collider = make_collider({.rules = rules, .piece_length = 0.5});
    crowds = create<Crowd>(range(2));
  });
  co_await epoch([&] { crowds.broadcast<&Crowd::submit>(collider, n_boxes, in_pieces, models); });
  co_await collider.run({report_to<&Crowd::receive>(crowds), {}});
  received = co_await crowds.reduce<&Crowd::gather>();
}

/// Of n boxes per crowd: pairs (i, j) of the two crowds, and the pairs within one.
void check_received(const std::vector<std::uint64_t>& received, std::uint64_t n,
                    WithinModel within) {
  const std::uint64_t sum = n * (n - 1) / 2, squares = sum * (2 * n - 1) / 3;
  const bool has_within = within == WithinModel::test;  // or each box has a model
  const std::uint64_t n_pairs = n * n + (has_within ? sum : 0);
  const std::uint64_t products = sum * sum + (has_within ? (sum * sum - squares) / 2 : 0);
  REQUIRE(received.size() == 8);
  for (const std::size_t crowd : {std::size_t{0}, std::size_t{4}}) {
    REQUIRE(received[crowd] == n_pairs);
    REQUIRE(received[crowd + 1] == products);
    REQUIRE(received[crowd + 2] <= most_pairs);
    REQUIRE(received[crowd + 3] < 100);
  }
}

}  // namespace

TEST_CASE("each pair of equal boxes is reported once, in portions",
          "[collide][parallel][pair_search]") {
  const std::vector<std::string> machines{"--pes=1",
                                          "--sim=pes=2,per-process=1,cost=100ns,migrate=0.1,seed=8",
                                          "--pes=2", "--sim=pes=3,cost=100ns,migrate=0.1,seed=5"};
  for (const WithinModel within : {WithinModel::test, WithinModel::skip})
    for (const bool in_pieces : {false, true})
      for (const std::string& option : std::span(machines).first(in_pieces ? 2 : 4)) {
        const std::int32_t n = in_pieces ? 520 : 900;
        Setup setup = tests::setup_of(option);
        std::vector<std::uint64_t> received;
        CAPTURE(option, in_pieces, within == WithinModel::test);
        REQUIRE(run(setup, [&] {
                  return collide_crowds(n, in_pieces, Models::of_crowds, {Touching::counts, within},
                                        received);
                }) == 0);
        check_received(received, static_cast<std::uint64_t>(n), within);
      }
}

// A search per pair of models found one pair each, and its owners were awaited each time.
TEST_CASE("boxes with a model each are searched in as few portions",
          "[collide][parallel][pair_search]") {
  for (const std::string option :
       {"--pes=1", "--sim=pes=2,per-process=1,cost=100ns,migrate=0.1,seed=8"}) {
    constexpr std::int32_t n = 600;
    Setup setup = tests::setup_of(option);
    std::vector<std::uint64_t> received;
    CAPTURE(option);
    REQUIRE(run(setup, [&] { return collide_crowds(n, false, Models::of_boxes, {}, received); }) ==
            0);
    check_received(received, n, WithinModel::test);
  }
}
