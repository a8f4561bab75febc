// Elements that other code of their PE calls as objects.
#include "runtime/array_proxy.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/over_seeds.hpp"

namespace {

class SizedCounter : public tess::Chare<SizedCounter> {
 public:
  void set(int value) { value_ = value; }
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_ = 0;
};

/// Is told to move and to end.
class Summoned : public tess::Chare<Summoned> {
 public:
  void go(tess::PeId pe) { migrate_to(pe); }
  void end() { destroy(); }
  void count(tess::Callback<int> target) { contribute(tess::sum, 1, target); }
  [[nodiscard]] tess::PeId pe() { return tess::my_pe(); }
  tess::Task rest() {
    (void)co_await self().ask<&Summoned::pe>();
    ++n_rests_;
  }
  [[nodiscard]] int n_rests() { return n_rests_; }
  void serialize(auto& ar) { ar(n_rests_); }

 private:
  int n_rests_ = 0;
};

tess::Task call_two(bool in_any_order) {
  const auto summoned = tess::create<Summoned>(tess::range(8));
  co_await tess::epoch([&] {
    summoned.local({0})->go(tess::PeId{3});
    summoned.local({1})->end();
  });
  if (!in_any_order) {  // otherwise it may have gone on
    const tess::PeId pe = co_await summoned[0].ask<&Summoned::pe>();
    CHECK(pe == tess::PeId{3});
  }
  const int left = co_await summoned.reduce<&Summoned::count>();
  CHECK(left == 7);
}

tess::Task call_coroutine() {
  const auto summoned = tess::create<Summoned>(tess::range(8));
  co_await tess::epoch([&] {
    const tess::Task rests = summoned.local({0})->rest();
    summoned[0].send<&Summoned::go>(tess::PeId{3});
  });
  const int n = co_await summoned[0].ask<&Summoned::n_rests>();
  CHECK(n == 1);
}

}  // namespace

TEST_CASE("an element is found on its PE only", "[runtime][array]") {
  REQUIRE(tests::run(tess::text(tests::two_processes, ",seed=1"), []() -> tess::Task {
            const auto nodes = tess::create<SizedCounter>(tess::range(8));
            CHECK(nodes.local({0}) != nullptr);  // the first block of indices is on PE 0
            CHECK(nodes.local({7}) == nullptr);
            CHECK(nodes.local({8}) == nullptr);
            CHECK(tess::my_pe() == tess::PeId{0});
            CHECK(tess::n_pes() == 4);
            CHECK(tess::machine().virtual_time());
            const tess::Time before = tess::now();
            co_await tess::epoch([&] { nodes.broadcast<&SizedCounter::set>(9); });
            CHECK(tess::now() > before);
            CHECK(nodes.local({0})->value() == 9);
          }).exit_code == 0);
}

TEST_CASE("an element that other code calls as an object moves and ends", "[runtime][array]") {
  REQUIRE(tests::run(tests::two_processes, [] { return call_two(false); }).exit_code == 0);
  tests::over_seeds(20, tests::two_processes, [] { return call_two(true); });
}

TEST_CASE("an element stays while its coroutine waits that other code called", "[runtime][array]") {
  tests::over_seeds(20, tests::two_processes, &call_coroutine);
}
