#include "runtime/base/pool.hpp"
#include "tests/support/catch.hpp"

#include <cstring>
#include <set>
#include <thread>
#include <vector>

namespace tess::detail {
namespace {

TEST_CASE("blocks of all sizes are aligned, apart and writable", "[runtime][base]") {
  Pool pool;
  std::vector<std::pair<unsigned char*, std::size_t>> blocks;
  for (std::size_t bytes = 0; bytes < 3000; bytes += 7) {
    auto* const block = static_cast<unsigned char*>(pool.allocate(bytes));
    REQUIRE(reinterpret_cast<std::uintptr_t>(block) % 16 == 0);
    std::memset(block, static_cast<int>(bytes % 251), bytes);
    blocks.emplace_back(block, bytes);
  }
  std::size_t n_changed = 0;
  for (const auto& [block, bytes] : blocks)
    for (std::size_t i = 0; i < bytes; ++i)
      if (block[i] != bytes % 251) ++n_changed;
  CHECK(n_changed == 0);
  for (const auto& [block, bytes] : blocks) Pool::release(block, &pool);
}

TEST_CASE("a freed block is the next one of its size", "[runtime][base]") {
  if (!Pool::reuses_blocks) return;
  Pool pool;
  void* const a = pool.allocate(100);
  Pool::release(a, &pool);
  CHECK(pool.allocate(110) == a);
  Pool::release(a, &pool);
}

TEST_CASE("blocks freed by another pool come home", "[runtime][base]") {
  if (!Pool::reuses_blocks) return;
  Pool home, other;
  std::set<void*> blocks;
  for (int i = 0; i < 40; ++i) blocks.insert(home.allocate(1000));
  const std::size_t held = home.held_bytes();
  for (void* block : blocks) Pool::release(block, &other);
  other.flush();
  std::vector<void*> again;
  for (int i = 0; i < 40; ++i) again.push_back(home.allocate(1000));
  CHECK(home.held_bytes() == held);
  CHECK(other.held_bytes() == 0);
  for (void* block : again) Pool::release(block, &home);
}

TEST_CASE("a thread without a pool allocates and frees", "[runtime][base]") {
  Pool pool;
  void* const theirs = pool.allocate(64);
  void* const unpooled = Pool::allocate(64, nullptr);
  Pool::release(theirs, nullptr);
  Pool::release(unpooled, &pool);
  Pool::release(Pool::allocate(64, nullptr), nullptr);
  SUCCEED("asan finds no leak");
}

// The oracle is the count in flight: never more than `most`, so the pool may hold little more.
TEST_CASE("a flow in one direction does not accumulate memory", "[runtime][base]") {
  constexpr int n_blocks = 100'000;
  constexpr int most = 500;
  Pool producer, consumer;
  MpscQueue inbox;
  std::atomic<int> n_in_flight{0};
  std::jthread other([&] {
    for (int n = 0; n < n_blocks;) {
      Link* link = inbox.take_all();
      if (link == nullptr) std::this_thread::yield();
      while (link != nullptr) {
        Link* const next = link->next;
        Pool::release(link, &consumer);
        link = next;
        ++n;
        --n_in_flight;
      }
    }
    consumer.flush();
  });
  for (int i = 0; i < n_blocks; ++i) {
    while (n_in_flight.load() >= most) std::this_thread::yield();
    ++n_in_flight;
    inbox.push(::new (producer.allocate(40)) Link);
  }
  other.join();
  if (Pool::reuses_blocks) CHECK(producer.held_bytes() < 200'000);
  CHECK(consumer.held_bytes() == 0);
}

}  // namespace
}  // namespace tess::detail
