// Promises of order that a program can see: which coroutine a message goes to, and in which order a
// reduction combines.
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <numeric>
#include <optional>

namespace {

/// Without a seed messages keep their order.
template <class Main>
int simulate(std::int32_t n_pes, std::optional<std::uint64_t> seed, Main main) {
  const std::string by_seed = seed ? tess::text(",seed=", *seed) : "";
  return tests::run(tess::text("pes=", n_pes, ",cost=100ns", by_seed), std::move(main)).exit_code;
}

struct Note {
  int key = 0;
  int number = 0;
};
std::vector<int> served;  // one thread runs all simulated PEs

class Taker : public tess::Chare<Taker, tess::Index1> {
 public:
  tess::Task read(int waiter) {
    const Note note = co_await notes_.take(7);
    served.push_back(10 * waiter + note.number);
  }
  void put(int number) { notes_.put(Note{7, number}); }

 private:
  tess::Mailbox<&Note::key> notes_;
};

class Giver : public tess::Chare<Giver, tess::Index1> {
 public:
  void give(tess::Callback<std::vector<int>> to) {
    contribute(tess::in_order(tess::concatenate), std::vector<int>{index().x}, to);
  }
};

tess::Task collect_values(std::vector<int>& gathered, int n) {
  const auto members = tess::create<Giver>(tess::sparse);
  co_await tess::epoch([&] {
    for (int i = 0; i < n; ++i) members[{(i * 37) % n}].insert_on(tess::PeId{i % 3});
  });
  gathered = co_await members.reduce<&Giver::give>();
}

class Pusher : public tess::Chare<Pusher, tess::Index1> {
 public:
  tess::Task push(tess::ArrayProxy<Taker> takers) {
    for (int number = 0; number < 3; ++number) {
      const auto to = takers[index().x];
      co_await tess::room(to);
      to.send<&Taker::put>(number);
      to.send<&Taker::read>(index().x);
    }
  }
};

}  // namespace

TEST_CASE("a message goes to the coroutine that has waited longest", "[runtime][mailbox]") {
  served.clear();
  const auto main = [] {
    const auto takers = tess::create<Taker>(tess::range(1));
    for (int i = 1; i <= 4; ++i) takers[{0}].send<&Taker::read>(i);
    for (int i = 1; i <= 4; ++i) takers[{0}].send<&Taker::put>(i);
  };
  REQUIRE(simulate(1, std::nullopt, main) == 0);
  CHECK(served == std::vector<int>{11, 22, 33, 44});
}

TEST_CASE("in_order combines in the order of indices, wherever the elements are",
          "[runtime][reduction]") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<int> gathered;
    REQUIRE(simulate(3, seed,
                     [&gathered]() -> tess::Task { return collect_values(gathered, 50); }) == 0);
    std::vector<int> expected(50);
    std::iota(expected.begin(), expected.end(), 0);
    CHECK(gathered == expected);
  }
}

TEST_CASE("there is room for messages to an array that this PE does not know yet",
          "[runtime][order]") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    served.clear();
    CHECK(simulate(4, seed, [] {
            const auto takers = tess::create<Taker>(tess::range(8));
            const auto pushers = tess::create<Pusher>(tess::range(8));
            pushers.broadcast<&Pusher::push>(takers);
          }) == 0);
    CHECK(served.size() == 24);
  }
}
