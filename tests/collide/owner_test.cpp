// The owners of objects: elements of arrays of two and three dimensions, and members of groups.
#include "collide/collider.hpp"
#include "collide/pairs.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

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
    members = create<CountingMember>(each_pe);
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

/// A name of a target that is too long to be stored in place.
void take_nothing(const Callback<Hits>& /*call*/, Hits&& /*hits*/) {}
const Callback<Hits>::Kind long_kind{naming::name_of<&take_nothing>(), &take_nothing};

Task collide_nothing(const Callback<Hits>& call) {
  const Collider collider = make_collider({});
  for (int i = 0; i < 4; ++i) co_await collider.run({call, ModelId{0}});
}

}  // namespace

TEST_CASE("a report is destroyed once that is written in the expression that awaits the collision",
          "[collide][owner]") {
  const std::vector<std::byte> name(100, std::byte{7});
  const Callback<Hits> call(long_kind, name);
  test::Machine{.pes = 1}.run([&] { return collide_nothing(call); }).require_success();
  CHECK(std::ranges::equal(call.where(), name));
}

TEST_CASE("owners may be elements of arrays of two and three dimensions, and members of groups",
          "[collide][parallel]") {
  std::int64_t n_received = 0;
  const test::Machine machine{.pes = 3, .seed = 5};
  machine.run([&] { return report_to_all(n_received); }).require_success();
  REQUIRE(n_received == 2 * 3);
  REQUIRE_THROWS_WITH(owner_of(Index3{0, 1 << 20, 0}), Contains("more than 21 bits"));
  REQUIRE_THROWS_WITH(owner_of(Index2{0, 1 << 30}), Contains("more than 31 bits"));
}

TEST_CASE("an owner of another array is refused with its index and the class of the receivers",
          "[collide][parallel]") {
  const auto report = [](OwnerId of) {
    const test::Machine machine{.pes = 2, .seed = 7};
    const auto result = machine.run([of]() -> Task {
      ArrayProxy<Counter<Index1>> row;
      co_await epoch([&] { row = create<Counter<Index1>>(range(3)); });
      std::int64_t n = 0;
      co_await collide_two<decltype(row), Counter<Index1>>(
          row, owner_of(Index1{2}), of, report_to<&Counter<Index1>::receive>(row), n);
    });
    CHECK(result.exit_code == (of == owner_of(Index1{1}) ? 0 : 2));
    return result.report.empty() ? std::string() : result.report.front();
  };
  CHECK(report(owner_of(Index1{1})).empty());
  for (const OwnerId wrong : {owner_of(Index2{0, 1}), owner_of(Index3{0, 0, 1})}) {
    const std::string said = report(wrong);
    CAPTURE(said);
    CHECK_THAT(said, Contains("report_to() "));
    CHECK_THAT(said, Contains("Counter<"));
    CHECK_THAT(said, Contains("the owner " + owner_text(wrong) +
                              " is no element of an array of 1 dimension"));
  }
  CHECK(owner_text(owner_of(Index2{-3, 4})) == "[-3,4]");
  CHECK(owner_text(owner_of(Index3{-3, 4, 5})) == "[-3,4,5]");
}

TEST_CASE("pairs within a model count on chares and in one thread alike", "[collide][parallel]") {
  const std::array boxes{Aabb{{0, 0, 0}, {1, 1, 1}}, Aabb{{0.5, 0, 0}, {2, 1, 1}}};
  std::int64_t n = 0;
  const test::Machine machine{.pes = 2, .seed = 3};
  machine
      .run([&]() -> Task {
        GroupProxy<CountingMember> members;
        co_await epoch([&] { members = create<CountingMember>(each_pe); });
        const Collider collider = make_collider({});
        collider.submit(Objects{owner_of(PeId{0}), ModelId{0}, boxes});
        co_await collider.run({report_to<&CountingMember::receive>(members), {}});
        n = co_await members.reduce<&CountingMember::count>();
      })
      .require_success();
  CHECK(n == 1);
  CHECK(count_pairs(std::span<const Aabb>(boxes)) == 1);
}
