// The owners of objects: elements of arrays of two and three dimensions, and members of groups.
#include "collide/collider.hpp"
#include "runtime/runtime.hpp"
#include "runtime/testing.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cstdint>

using namespace tess;
using namespace tess::collide;

namespace {

/// Owners that count their hits, on a grid of two or three dimensions or on every PE.
template <class IndexType>
class Counter : public Chare<Counter<IndexType>, IndexType> {
 public:
  void receive(const Hits& hits) {
    TESS_CHECK(hits.owner == owner_of(this->index()), "hits of another owner");
    n_ += static_cast<std::int64_t>(hits.pairs.size());
  }
  void count(Callback<std::int64_t> target) { this->contribute(sum, n_, target); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_);
  }

 private:
  std::int64_t n_ = 0;
};
class CountingMember : public Group<CountingMember> {
 public:
  void receive(const Hits& hits) { n_ += static_cast<std::int64_t>(hits.pairs.size()); }
  void count(Callback<std::int64_t> target) { contribute(sum, n_, target); }

 private:
  std::int64_t n_ = 0;
};

/// Two owners with a box each, which touch: two hits.
template <class Owners, class Owner>
Task collide_two(Owners owners, OwnerId a, OwnerId b, Callback<Hits> call, std::int64_t& n) {
  const Collider collider = make_collider({});
  collider.submit(Objects{a, ModelId{0}, std::array{Aabb{{0, 0, 0}, {1, 1, 1}}}});
  collider.submit(Objects{b, ModelId{1}, std::array{Aabb{{1, 1, 1}, {2, 2, 2}}}});
  co_await collider.run({call, {}});
  n += co_await owners.template reduce<&Owner::count>();
}

Task report_to_all(std::int64_t& n) {
  ArrayProxy<Counter<Index2>> flat;
  ArrayProxy<Counter<Index3>> deep;
  GroupProxy<CountingMember> members;
  co_await epoch([&] {
    flat = create<Counter<Index2>>(sparse);
    deep = create<Counter<Index3>>(sparse);
    members = create_group<CountingMember>();
  });
  co_await epoch([&] {
    flat[{-1, 2}].insert();
    flat[{3, -4}].insert();
    deep[{-1, 2, -3}].insert();
    deep[{1000000, -1000000, 7}].insert();
  });
  co_await collide_two<decltype(flat), Counter<Index2>>(
      flat, owner_of(Index2{-1, 2}), owner_of(Index2{3, -4}),
      report_to<&Counter<Index2>::receive>(flat), n);
  co_await collide_two<decltype(deep), Counter<Index3>>(
      deep, owner_of(Index3{-1, 2, -3}), owner_of(Index3{1000000, -1000000, 7}),
      report_to<&Counter<Index3>::receive>(deep), n);
  co_await collide_two<decltype(members), CountingMember>(
      members, owner_of(PeId{0}), owner_of(PeId{2}), report_to<&CountingMember::receive>(members),
      n);
}

}  // namespace

TEST_CASE("owners may be elements of arrays of two and three dimensions, and members of groups",
          "[collide][parallel]") {
  std::int64_t n_received = 0;
  const test::Machine machine{.pes = 3, .seed = 5};
  machine.run([&]() -> Task { return report_to_all(n_received); }).require_success();
  REQUIRE(n_received == 2 * 3);
  REQUIRE_THROWS_WITH(owner_of(Index3{0, 1 << 20, 0}), Catch::Contains("more than 21 bits"));
}
