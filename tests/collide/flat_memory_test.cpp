// Colliders that end leave no memory behind, as the system sees it, and pairs without number need
// little.
#include "collide/collider.hpp"
#include "runtime/more/scoped.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/resident.hpp"
#include "tests/support/run.hpp"

#include <sys/resource.h>
#include <vector>

namespace {

using namespace tess;
using namespace tess::collide;

/// Owns one box in a row in which each box overlaps the next.
class Client : public Chare<Client> {
 public:
  void submit(const Collider& collider) {
    const double x = index().x;
    const auto model = static_cast<ModelId>(index().x % 2);
    collider.submit({{{{x, 0, 0}, {x + 1.5, 1, 1}}, {owner_of(index()), {}, model}}});
  }
  void receive(const Hits& hits) { n_pairs_ += hits.pairs.size(); }
  void count(Callback<std::uint64_t> target) { contribute(sum, n_pairs_, std::move(target)); }

 private:
  std::uint64_t n_pairs_ = 0;
};

/// Owns boxes that are all equal.
class Crowd : public Chare<Crowd> {
 public:
  void submit(const Collider& collider, std::int32_t n_boxes) {
    const std::vector<Aabb> boxes(static_cast<std::size_t>(n_boxes), Aabb{{0, 0, 0}, {1, 1, 1}});
    collider.submit(Objects{owner_of(index()), {}, boxes});
  }
  void receive(const Hits& hits) { n_pairs_ += hits.pairs.size(); }
  void count(Callback<std::uint64_t> target) { contribute(sum, n_pairs_, std::move(target)); }

 private:
  std::uint64_t n_pairs_ = 0;
};

Task collide_crowd(std::int32_t n_boxes, std::uint64_t& n_pairs) {
  Collider collider;
  ArrayProxy<Crowd> crowd;
  co_await epoch([&] {
    collider = make_collider({.rules = {.within_model = WithinModel::test}});
    crowd = create<Crowd>(range(1));
  });
  co_await epoch([&] { crowd.broadcast<&Crowd::submit>(collider, n_boxes); });
  co_await collider.run({report_to<&Crowd::receive>(crowd), {}});
  n_pairs = co_await crowd.reduce<&Crowd::count>();
}

std::int64_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

constexpr int n_clients = 8;

Task collide_once(ArrayProxy<Client> clients) {
  const Scoped collider(
      make_collider({.voxel_size = {1, 1, 1}, .rules = {.within_model = WithinModel::skip}}));
  co_await epoch([&] { clients.broadcast<&Client::submit>(collider); });
  co_await collider.run(report_to<&Client::receive>(clients));
}

Task collide_often(tess::test::Growth& growth, std::uint64_t& n_pairs) {
  const auto clients = create<Client>(range(n_clients));
  for (int round = 1; round <= growth.n_rounds(); ++round) {
    co_await epoch([&] { const Task work = collide_once(clients); });
    growth.after(round);
  }
  CHECK(n_collections() == 1);
  n_pairs = co_await clients.reduce<&Client::count>();
}

TEST_CASE("colliders in a loop leave memory flat", "[collide]") {
  tess::test::Growth growth(8000);
  std::uint64_t n_pairs = 0;
  REQUIRE(tests::run_threads(2, [&] { return collide_often(growth, n_pairs); }).exit_code == 0);
  CHECK(n_pairs == 8000 * 2 * (n_clients - 1));  // both owners receive each pair
  INFO("grows by " << growth.bytes() << " bytes from round 2000 to 8000");
  REQUIRE(growth.bytes() >= 0);
  CHECK(growth.bytes() < 1 << 20);
}

TEST_CASE("the pairs of 20 000 equal boxes, 1.6 GB, take less than 64 MiB", "[collide]") {
  constexpr std::uint64_t n = 20'000;
  const std::int64_t before = peak_bytes();
  std::uint64_t n_pairs = 0;
  REQUIRE(tests::run_threads(2, [&] { return collide_crowd(n, n_pairs); }).exit_code == 0);
  CHECK(n_pairs == n * (n - 1) / 2);
  CHECK(peak_bytes() - before < 64 << 20);
}

}  // namespace
