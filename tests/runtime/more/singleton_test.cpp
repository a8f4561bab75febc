// Single chares.
#include "runtime/more/singleton.hpp"

#include "runtime/more/testing.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/over_seeds.hpp"

#include <string>
#include <utility>
#include <vector>

namespace {

using namespace std::chrono_literals;

/// Has no default constructor.
class Named : public tess::Chare<Named> {
 public:
  explicit Named(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] std::string name() const { return name_; }

 private:
  std::string name_;
};

/// Collects the order in which its calls run.
class Desk : public tess::Chare<Desk> {
 public:
  void add(int number) { order_.push_back(number); }
  int note(int number) {
    order_.push_back(number);
    return number;
  }
  [[nodiscard]] std::vector<int> order() const { return order_; }
  void serialize(auto& ar) { ar(order_); }

 private:
  std::vector<int> order_;
};

/// All calls are ready before the first runs: they are sent within one entry method.
tess::Task ask_with_priorities(std::vector<int>& order, int& late) {
  const auto desk = tess::create<Desk>(tess::one_on(tess::PeId{0}));
  co_await tess::epoch([] {});
  (void)co_await desk.ask<&Desk::order>();
  auto third = desk.with(tess::Priority{3}).ask<&Desk::note>(3);
  auto plain = desk.ask<&Desk::note>(0);
  auto first = desk.with(tess::expedited).ask<&Desk::note>(-9);
  auto second = desk.with(tess::Priority{-2}).ask<&Desk::note>(-2);
  (void)co_await tess::when_all(std::move(third), std::move(plain), std::move(first),
                                std::move(second));
  order = co_await desk.ask<&Desk::order>();
  const tess::Time began = tess::now();
  desk.send_after<&Desk::add>(2ms, 77);
  desk.send_after<&Desk::add>(1ms, 88).cancel();
  co_await tess::sleep(3ms);
  const std::vector<int> last = co_await desk.ask<&Desk::order>();
  late = tess::now() - began >= 2ms ? last.back() : 0;
}

/// Counts what it is sent, on whichever PE.
class Single : public tess::Chare<Single> {
 public:
  Single() = default;
  explicit Single(int start) : count_(start) {}
  void add(int n) { count_ += n; }
  void tell(tess::Callback<std::pair<int, int>> target) {
    target(std::pair(count_, tess::my_pe().value));
  }

  void serialize(auto& ar) { ar(count_); }

 private:
  int count_ = 0;
};

class SingleAdder : public tess::Group<SingleAdder> {
 public:
  void add(tess::ChareProxy<Single> to) { to.send<&Single::add>(1); }
};

tess::Task use_single(int& count, int& first_pe, int& last_pe, std::size_t& n_left) {
  const tess::PeId last{tess::n_pes() - 1};
  tess::ChareProxy<Single> anywhere;
  co_await tess::epoch([&] { anywhere = tess::create<Single>(tess::one, 1); });
  const auto single = tess::create<Single>(tess::one_on(last), 100);
  tess::Future<std::pair<int, int>> first, second;
  single.send<&Single::tell>(first.callback());
  const auto before = co_await first;
  first_pe = before.second;
  const auto senders = tess::create<SingleAdder>(tess::each_pe);
  co_await tess::epoch([&] {
    senders.broadcast<&SingleAdder::add>(single);
    single.migrate_to(tess::PeId{0});
    senders.broadcast<&SingleAdder::add>(single);
  });
  single.with(tess::expedited).send<&Single::tell>(second.callback());
  const auto after = co_await second;
  count = after.first;
  last_pe = after.second;
  co_await tess::epoch([&] {
    anywhere.destroy();
    single.destroy();
    senders.destroy();
  });
  n_left = tess::n_collections();
}

void check_single(int n_pes, const auto& run_on_machine, bool moves_by_force) {
  int count = 0, first_pe = -1, last_pe = -1;
  std::size_t n_left = 9;
  run_on_machine([&]() -> tess::Task { return use_single(count, first_pe, last_pe, n_left); });
  REQUIRE(count == 100 + 2 * n_pes);
  if (!moves_by_force) {
    REQUIRE(first_pe == n_pes - 1);
    REQUIRE(last_pe == 0);
  }
  REQUIRE(n_left == 0);
}

}  // namespace

TEST_CASE("a chare without a default constructor, alone and in a sparse array",
          "[runtime][single]") {
  tests::over_seeds(20, tests::two_processes, []() -> tess::Task {
    const auto anna = tess::create<Named>(tess::one, std::string("Anna"));
    const auto otto = tess::create<Named>(tess::one_on(tess::PeId{3}), std::string("Otto"));
    const auto others = tess::create<Named>(tess::sparse);
    others[{7}].insert(std::string("Ida"));
    const std::string a = co_await anna.ask<&Named::name>();
    const std::string b = co_await otto.ask<&Named::name>();
    const std::string c = co_await others[{7}].ask<&Named::name>();
    CHECK(a + b + c == "AnnaOttoIda");
  });
}

TEST_CASE("asks of a single chare run in the order of their priorities", "[runtime][ask]") {
  std::vector<int> order;
  int late = 0;
  const tess::test::Machine machine{.pes = 2, .reordering = 0, .migration = 0.0};
  machine.run([&]() -> tess::Task { return ask_with_priorities(order, late); }).require_success();
  CHECK(order == std::vector<int>{-9, -2, 0, 3});
  CHECK(late == 77);
}

TEST_CASE("a single chare is made where it is asked for, moves, and ends", "[runtime][single]") {
  for (const int n_pes : {1, 3}) {
    check_single(
        n_pes, [&](const auto& main) { REQUIRE(tests::run_threads(n_pes, main).exit_code == 0); },
        false);
  }
  tess::test::for_seeds(0, 100, [](std::uint64_t seed) {
    const tess::test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    check_single(
        machine.pes, [&](const auto& main) { machine.run(main).require_success(); }, true);
  });
}
