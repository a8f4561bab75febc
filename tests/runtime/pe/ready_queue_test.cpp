// The ready queue by itself, against a sorted list.
#include "runtime/pe/queues/ready_queue.hpp"

#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <vector>

namespace {

using tess::detail::Link;
using tess::detail::ReadyQueue;

struct Numbered : Link {
  std::int64_t priority = 0;
  std::uint64_t number = 0;
};

std::int64_t draw(tess::Random& random, std::uint64_t n_priorities) {
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  if (n_priorities == 0) return static_cast<std::int64_t>(random());  // all 64 bits
  const std::uint64_t which = random.below(n_priorities);
  if (which + 1 == n_priorities && n_priorities > 2) return least;
  return static_cast<std::int64_t>(which) - static_cast<std::int64_t>(n_priorities / 2);
}

/// Pushes and pops at random; the queue grows and shrinks. Each pop is compared with the first of
/// the messages in the order of (priority, number).
void compare_with_list(std::uint64_t seed) {
  tess::Random random(seed);
  constexpr std::array<std::uint64_t, 6> choices{1, 2, 3, 9, 300, 0};
  const std::uint64_t n_priorities = choices[seed % choices.size()];
  ReadyQueue queue;
  std::deque<Numbered> messages;
  std::vector<Numbered*> expected;
  for (std::uint64_t step = 0; step < 3000; ++step) {
    const double growth = (step / 500) % 2 == 0 ? 0.6 : 0.4;
    if (random.chance(growth)) {
      Numbered& one = messages.emplace_back();
      one.priority = draw(random, n_priorities);
      one.number = step;
      if (one.priority == 0 && random.chance(0.5)) {
        queue.push(&one);
      } else {
        queue.push(&one, one.priority);
      }
      expected.push_back(&one);
    } else if (!expected.empty()) {
      const auto first = std::min_element(
          expected.begin(), expected.end(), [](const Numbered* a, const Numbered* b) {
            return a->priority != b->priority ? a->priority < b->priority : a->number < b->number;
          });
      const auto* const popped = static_cast<const Numbered*>(queue.pop());
      INFO("seed " << seed << ", step " << step);
      REQUIRE(popped->priority == (*first)->priority);
      REQUIRE(popped->number == (*first)->number);
      expected.erase(first);
    }
    REQUIRE(queue.size() == expected.size());
    REQUIRE(queue.empty() == expected.empty());
  }
  std::size_t n_visited = 0;
  queue.for_each([&](const Link* /*link*/) { ++n_visited; });
  CHECK(n_visited == expected.size());
}

}  // namespace

TEST_CASE("the ready queue gives the smallest priority first, and equal ones in their order",
          "[runtime][priority]") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) compare_with_list(seed);
}

TEST_CASE("a message without a priority runs between negative and positive ones",
          "[runtime][priority]") {
  ReadyQueue queue;
  std::array<Link, 5> links;
  queue.push(&links[3], 1);
  queue.push(&links[2]);
  queue.push(&links[1], -1);
  queue.push(&links[0], std::numeric_limits<std::int64_t>::min());
  queue.push(&links[4], std::numeric_limits<std::int64_t>::max());
  for (Link& link : links) CHECK(queue.pop() == &link);
  CHECK(queue.empty());
}

TEST_CASE("a priority whose messages have all run is used again", "[runtime][priority]") {
  ReadyQueue queue;
  std::array<Link, 2> links;
  for (std::int64_t turn = 0; turn < 1000; ++turn) {
    const std::int64_t priority = 1 + turn % 100;
    queue.push(&links[0], priority);
    queue.push(&links[1], priority);
    REQUIRE(queue.pop() == &links[0]);
    REQUIRE(queue.pop() == &links[1]);
    REQUIRE(queue.empty());
  }
}
