#include "runtime/base/mpsc_queue.hpp"

#include "tests/support/catch.hpp"

#include <thread>
#include <vector>

namespace tess::detail {
namespace {

struct Item : Link {
  int producer = 0;
  int number = 0;
};

TEST_CASE("links come out in the order in which they were pushed", "[runtime][base]") {
  MpscQueue queue;
  std::vector<Item> items(5);
  for (int i = 0; i < 5; ++i) items[static_cast<std::size_t>(i)].number = i;
  for (Item& item : items) queue.push(&item);

  int expected = 0;
  for (Link* link = queue.take_all(); link != nullptr; link = link->next)
    CHECK(static_cast<Item*>(link)->number == expected++);
  CHECK(expected == 5);
  CHECK(queue.empty());
  CHECK(queue.take_all() == nullptr);
}

TEST_CASE("a push says whether the queue was empty", "[runtime][base]") {
  MpscQueue queue;
  Item a, b, c;
  CHECK(queue.push(&a));
  CHECK_FALSE(queue.push(&b));
  CHECK(queue.take_all() == &a);
  CHECK(queue.push(&c));
}

TEST_CASE("a chain is pushed at once and taken newest first", "[runtime][base]") {
  MpscQueue queue;
  Item a, b, c;
  b.next = &c;
  CHECK(queue.push(&a));
  CHECK_FALSE(queue.push_chain(&b, &c));
  Link* link = queue.take_all_reversed();
  CHECK(link == &b);
  CHECK(link->next == &c);
  CHECK(link->next->next == &a);
}

TEST_CASE("no link is lost or overtaken by one of its own producer", "[runtime][base]") {
  constexpr int n_producers = 4;
  constexpr int n_items = 20'000;
  MpscQueue queue;
  std::vector<std::vector<Item>> items(n_producers, std::vector<Item>(n_items));
  std::vector<std::jthread> producers;
  for (int p = 0; p < n_producers; ++p)
    producers.emplace_back([&queue, p, &mine = items[static_cast<std::size_t>(p)]] {
      for (int i = 0; i < n_items; ++i) {
        Item& item = mine[static_cast<std::size_t>(i)];
        item.producer = p;
        item.number = i;
        queue.push(&item);
      }
    });

  std::vector<int> next(n_producers, 0);
  int n_taken = 0;
  int n_overtaken = 0;
  while (n_taken < n_producers * n_items) {
    Link* link = queue.take_all();
    if (link == nullptr) std::this_thread::yield();
    for (; link != nullptr; link = link->next, ++n_taken) {
      const auto* item = static_cast<Item*>(link);
      if (next[static_cast<std::size_t>(item->producer)]++ != item->number) ++n_overtaken;
    }
  }
  CHECK(n_overtaken == 0);
}

}  // namespace
}  // namespace tess::detail
