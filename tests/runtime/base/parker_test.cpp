#include "runtime/base/parker.hpp"

#include "runtime/base/backoff.hpp"
#include "runtime/base/mpsc_queue.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace tess::detail {
namespace {

using namespace std::chrono_literals;

std::chrono::nanoseconds time_of(auto&& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::steady_clock::now() - begin;
}

TEST_CASE("a parker does not sleep when there is work already", "[runtime][base]") {
  Parker parker;
  int n_asked = 0;
  const auto ready = [&] { return ++n_asked > 0; };
  CHECK(time_of([&] { parker.park(30s, ready); }) < 15s);
  CHECK(n_asked == 1);
}

// It may return early without a reason, but not three times in a row.
TEST_CASE("a parker without work sleeps until its time is over, and no longer", "[runtime][base]") {
  Parker parker;
  std::chrono::nanoseconds longest{0};
  for (int i = 0; i < 3; ++i) {
    const auto slept = time_of([&] { parker.park(5ms, [] { return false; }); });
    CHECK(slept < 15s);
    longest = std::max(longest, slept);
  }
  CHECK(longest >= 5ms);
}

TEST_CASE("a wake-up that comes after the last look at the queue ends the sleep",
          "[runtime][base]") {
  Parker parker;
  const auto woken_before_sleep = [&] {
    parker.wake();
    return false;
  };
  CHECK(time_of([&] { parker.park(30s, woken_before_sleep); }) < 15s);
}

// A lost wake-up shows as a hang: neither side goes on without the other.
TEST_CASE("no wake-up is lost between two threads that sleep in turn", "[runtime][base]") {
  constexpr int n_rounds = 20'000;
  struct Side {
    MpscQueue inbox;
    Parker parker;
  };
  Side a, b;
  const auto take = [](Side& side) {
    Link* link = nullptr;
    while ((link = side.inbox.take_all()) == nullptr)
      side.parker.park(Parker::forever, [&] { return !side.inbox.empty(); });
    return link;
  };
  const auto give = [](Side& side, Link* link) {
    if (side.inbox.push(link)) side.parker.wake();
  };
  Link ball;
  std::jthread other([&] {
    for (int i = 0; i < n_rounds; ++i) give(a, take(b));
  });
  int n_returned = 0;
  for (int i = 0; i < n_rounds; ++i) {
    give(b, &ball);
    if (take(a) == &ball) ++n_returned;
  }
  CHECK(n_returned == n_rounds);
}

TEST_CASE("only the producer that finds the queue empty has to wake", "[runtime][base]") {
  constexpr int n_producers = 3;
  constexpr int n_items = 10'000;
  MpscQueue inbox;
  Parker parker;
  std::vector<std::vector<Link>> items(n_producers, std::vector<Link>(n_items));
  std::vector<std::jthread> producers;
  for (auto& mine : items)
    producers.emplace_back([&] {
      for (Link& link : mine) {
        if (inbox.push(&link)) parker.wake();
        if ((reinterpret_cast<std::uintptr_t>(&link) >> 4) % 8 == 0) std::this_thread::yield();
      }
    });
  int n_taken = 0;
  while (n_taken < n_producers * n_items) {
    for (Link* link = inbox.take_all(); link != nullptr; link = link->next) ++n_taken;
    if (n_taken < n_producers * n_items)
      parker.park(Parker::forever, [&] { return !inbox.empty(); });
  }
  CHECK(n_taken == n_producers * n_items);
}

TEST_CASE("a backoff without patience sleeps at once, and again after a reset", "[runtime][base]") {
  Backoff rest(Patience{});
  while (!rest.pause()) std::this_thread::yield();
  CHECK(rest.pause());
  // If another program took the core in between, it sleeps at once for a third of a second.
  bool rests = true;
  for (int i = 0; i < 50 && rests; ++i) {
    rest.reset();
    rests = rest.pause();
    if (rests) std::this_thread::sleep_for(std::chrono::milliseconds(400));
  }
  CHECK_FALSE(rests);
}

}  // namespace
}  // namespace tess::detail
